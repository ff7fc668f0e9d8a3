// What each feature of the page rests on, and what stands in its stead where it is taken out.
//
// By sentence of a test: [the feature, its file, the text, the text instead, the size if at one alone]. The
// text stands in the file once; a file without a text is missing. A page so broken still comes up: the test
// itself must notice.

const NOTHING = '';

const BY_SENTENCE = {
  // ---- The window and the panel ---------------------------------------------------------------

  'the picture fills the window and the controls fold away': [
    ['folding', 'panel.js', `byId('panel').hidden = !open;`, `byId('panel').hidden = false;`],
    ['a way back', 'panel.js', `byId('open').addEventListener('click', () => show(true));`, NOTHING],
    ['filling the window', 'style.css', 'inset: 0;\n  width: 100%;\n  height: 100%;\n  object-fit: contain;',
     'inset: 0;\n  width: 80%;\n  height: 100%;\n  object-fit: contain;'],
  ],
  'every number of the schema has a slider, in a group': [
    ['sliders', 'editors.js', `h('div', { className: 'number' }, slider,`, `h('div', { className: 'number' },`],
    ['units', 'editors.js', `const unit = unitText(node['x-unit']);`, `const unit = '';`],
    ['a group of its own for the light', 'panel.js', `['light', 'Light'], `, NOTHING],
  ],
  'keys step a number from where it is, beyond its slider too': [
    ['where it is', 'editors.js', 'scale.stepped(binding.get(), steps)', 'scale.toValue(Math.round(slider.valueAsNumber) + steps)'],
    ['what is allowed', 'numbers.js', 'return Math.min(most, Math.max(least, whole));', 'return whole;'],
  ],
  'no slider and no form leads to what is refused': [
    ['the end of a perspective', 'page.js', 'controls.most = (path) => camera.most(path);', NOTHING],
    ['tables of altitudes', 'schema.js', 'altitude_km: [0, 10, 100], density: [1, 0.3, 0]', NOTHING],
    ['tables of angles', 'schema.js', 'angle_deg: [0, 90, 180], ', NOTHING],
  ],
  'where all of Show is taken away, nothing else is changed': [
    ['what is a spectrum', 'together.js', 'Array.isArray(value) && this.schema.isSpectrum(node) &&', 'Array.isArray(value) &&'],
  ],
  'a number can be typed, and given back': [
    ['typed values', 'editors.js', 'else binding.set(value);\n    },\n    onkeydown', '},\n    onkeydown'],
    ['reset', 'controls.js', 'hidden: true, onclick: () => state.edit({ [path]: undefined }),', 'hidden: true,'],
  ],
  'what is not a number is refused where it was typed': [
    ['saying so', 'editors.js', `if (value === undefined) binding.complain(whyNoNumber(typed.value));\n      else binding.set(value);\n    },\n    onkeydown`,
     'if (value !== undefined) binding.set(value);\n    },\n    onkeydown'],
    ['thousands', 'numbers.js', `typed === '' || AMBIGUOUS.test(typed)`, `typed === ''`],
  ],
  'a logarithmic slider moves by factors': [
    ['logarithmic scales', 'numbers.js', `slider.scale === 'log' && this.high > 0;`, 'false;'],
  ],
  'help says in words what a control is': [
    ['help', 'controls.js', 'this.help.hidden = !this.help.hidden;', NOTHING],
    ['its words', 'controls.js', `hidden: true }, node.description ?? '');`, `hidden: true });`],
  ],

  // ---- The air --------------------------------------------------------------------------------

  'constituents have cards; they are switched off, added and removed': [
    ['their sliders', 'constituents.js', '...shown.map((name) => this.controls.make(`${path}.${name}`, members[name])),', NOTHING],
    ['switching off', 'constituents.js', 'this.state.edit({ [path]: null });', NOTHING],
    ['switching on', 'constituents.js', 'this.state.edit({ [path]: undefined, ...Object.fromEntries(changes) });', NOTHING],
    ['adding', 'constituents.js', 'this.state.edit({ [`${ROOT}.${free}`]: TEMPLATES[template] });', NOTHING],
    ['removing', 'constituents.js', 'this.state.edit({ [`${ROOT}.${name}`]: undefined });', NOTHING],
  ],
  'a constituent that was changed comes back as it was': [
    ['its changes', 'constituents.js', '...Object.fromEntries(changes) });', '});'],
    ['what it inherits', 'constituents.js', '{ [path]: undefined, ...Object.fromEntries(changes) }', '{ [path]: kept?.patch }'],
  ],
  'a card stays under the hand': [
    ['the same card in any order', 'constituents.js', 'Object.keys(value).sort(), hasTie', 'Object.keys(value), hasTie'],
    ['the keys where they were', 'constituents.js', 'focus();\n    this.#live', 'this.#live'],
  ],
  'a constituent is drawn against altitude, angle and wavelength': [
    ['the profile', 'curves.js', 'profile: drawProfile,', 'profile: () => undefined,'],
    ['the phase as a polar plot', 'curves.js', 'phase: drawPhase,', 'phase: drawCoefficient,'],
    ['the coefficients', 'curves.js', 'coefficient: drawCoefficient }', 'coefficient: drawProfile }'],
    ['words where there is no phase', 'curves.js', `curves ? 'It does not scatter.' : ''`, `''`],
  ],
  'the curves follow the sliders': [
    ['asking anew', 'constituents.js', `if (this.list.querySelector('details[open]')) this.optics.refresh();`,
     `if (!this.optics.answer && this.list.querySelector('details[open]')) this.optics.refresh();`],
  ],
  'visibility and optical depth move together': [
    ['the optical depth that follows', 'together.js', 'if (now > 0 && value > 0) state.edit({ [path]: scaled(state.value(path), now / value) });', NOTHING],
    ['the visibility that follows', 'together.js', 'return known && then > 0 && now > 0 ? known * (then / now) : undefined;',
     'return known && (window.firstVisibility ??= known);'],
  ],
  'temperature and scale height move together when they are tied': [
    ['the tie', 'together.js', 'if (!this.#tied.has(root)) return {};', 'return {};'],
  ],
  'a spectrum is edited as red, green and blue': [
    ['setting one of three', 'editors.js', 'set: (value) => binding.set(binding.get().map((old, k) => (k === i ? value : old))),', 'set: () => {},'],
    ['wavelengths for three values', 'together.js', `return { 'spectrum.wavelengths_nm': USUAL_PRIMARIES_NM };`, 'return {};'],
  ],
  'a spectrum is edited as a curve of nodes': [
    ['dragging a node', 'spectrum.js', 'if (place.hasPointerCapture(event.pointerId)) this.#dragTo(spot(event));', NOTHING],
    ['keys on a node', 'spectrum.js', 'ArrowUp: () => raise(step), ArrowDown: () => raise(-step),', NOTHING],
    ['limits of a node', 'spectrum.js', `'aria-valuemin': Math.min(this.range.low, value), `, NOTHING],
    ['adding a node', 'spectrum.js', 'list.splice(this.#chosen, 0, [Math.round((left + right) / 2), tidy((a + b) / 2)]);', NOTHING],
  ],

  // ---- Hands on the picture -------------------------------------------------------------------

  'dragging looks around': [
    ['the drag', 'camera.js', 'else this.#drag(now.x - before.x, now.y - before.y);', NOTHING],
  ],
  'looking around starts from where the camera is, in a refused scene too': [
    ['waiting for that', 'camera.js', 'if (this.state.isKnown()) this.state.edit(members);', 'this.state.edit(members);'],
    ['the preset of what is refused', 'state.js', 'if (preset !== this.preset || this.isKnown()) return;', 'return;'],
  ],
  'the wheel, or two fingers, zoom': [
    ['the wheel', 'camera.js', `canvas.addEventListener('wheel', (event) => this.#wheel(event), { passive: false });`, NOTHING, 'desktop'],
    ['the pinch', 'camera.js', `if (this.#grip === 'pinch') this.zoom(gap / this.#gap());`, `if (this.#grip === 'pinch') return;`, 'phone'],
  ],
  'keys look, climb, move the sun and show their own help': [
    ['looking', 'camera.js', 'ArrowLeft: () => this.look(-step, 0), ArrowRight: () => this.look(step, 0),', NOTHING],
    ['climbing', 'camera.js', 'w: () => this.climb(1.15), s: () => this.climb(1 / 1.15),', NOTHING],
    ['zooming', 'camera.js', `'+': () => this.zoom(1 / 1.08),`, NOTHING],
    ['raising the sun', 'camera.js', 'd: () => this.#raiseSun(0.5), a: () => this.#raiseSun(-0.5),', NOTHING],
    ['the way home', 'camera.js', '0: () => this.#home(),', NOTHING],
    ['the sheet of keys', 'page.js', `if (event.key === '?') byId('help').showModal();\n    else if`, 'if'],
    ['folding by a key', 'page.js', 'this.panel.toggle();', ';'],
    ['its role', 'index.html', 'role="application" aria-roledescription="sky"', 'role="img"'],
  ],
  'keys of a single character can be switched off, and stay off': [
    ['switching off', 'page.js', ` || (event.key.length === 1 && !byId('shortcuts').checked)`, NOTHING],
    ['staying off', 'shortcuts.js', 'localStorage.setItem(NAME, value);', NOTHING],
  ],
  'one flies from the ground to space': [
    ['climbing', 'camera.js', `const edit = { 'camera.altitude_km': tidy(next, 4) };`, 'const edit = {};', 'desktop'],
    ['the horizon in sight', 'camera.js', `return { 'camera.pitch_deg': degrees(clamp(pitch - sunk, -90, 90)) };`, 'return {};'],
    ['the slider', 'editors.js', 'oninput: () => binding.set(Math.min(scale.toValue(Math.round(slider.valueAsNumber)), most())),', NOTHING, 'phone'],
    ['another picture', 'view.js', '#request({ width, height, moving }) {\n    const scene = this.scene();', '#request({ width, height, moving }) {\n    const scene = (this.first ??= this.scene());'],
  ],
  'everything can be reached with the tabulator': [
    ['sliders in their turn', 'editors.js', `type: 'range', min: 0, max: scale.positions,`, `type: 'range', tabIndex: -1, min: 0, max: scale.positions,`],
    ['help in its turn', 'index.html', '<button id="show-help"', '<button id="show-help" tabindex="-1"'],
    ['the first and the last tab', 'panel.js', 'Home: tabs[0], End: tabs.at(-1) }', '}'],
  ],
  'the sun can be dragged': [
    ['the grip on the sun', 'camera.js', `this.#isOnSun(event) ? 'sun' : 'look';`, `'look';`],
  ],

  // ---- The day --------------------------------------------------------------------------------

  'a place and a time set the sun; the strip shows the day from dawn to dusk': [
    ['slices of the day', 'day_strip.js', 'if (!signal.aborted) this.#put(bitmap, at);', NOTHING],
    ['its times', 'day_strip.js', `[[sunrise, 'sunrise'], [highest.time, 'highest'], [sunset, 'sunset']]`, '[]'],
    ['places', 'day.js', 'this.#move({ latitude_deg: latitude, longitude_deg: longitude });', NOTHING],
    ['dates', 'day.js', 'if (this.date.value) this.#move({ date: this.date.value });', NOTHING],
    ['the moment on the strip', 'day_strip.js', 'oninput: () => onChoose(this.slider.valueAsNumber / POSITIONS)', NOTHING],
  ],
  'the day plays as a time-lapse': [
    ['its frames', 'day.js', 'this.view.present(bitmap, facts);', NOTHING],
    ['its clock', 'day.js', 'this.#point(last, true);', NOTHING],
    ['stopping', 'day.js', 'if (this.#playing) return this.#lapse.stop();', 'if (this.#playing) return;'],
  ],
  'what is chosen while the day plays stays chosen': [
    ['looking again', 'day.js', 'last !== undefined && equal(before, this.state.snapshot())', 'last !== undefined'],
  ],
  'the strip is of the sky that is seen when it is looked at again': [
    ['looking again', 'page.js', `byId('adjust').addEventListener('shown', () => day.refresh());`, NOTHING],
  ],
  'a time that is none breaks nothing': [
    ['times', 'day.js', `Number.isNaN(local.getTime()) ? '' : local.toISOString()`, 'local.toISOString()'],
    ['places', 'day.js', '(Number.isFinite(angle) ? angle : usual)', '(angle ?? usual)'],
  ],
  'Play waits for its day; the strip is finished afterwards': [
    ['waiting', 'day.js', 'if (key === this.#key) return this.#known;', 'if (key === this.#key) return undefined;'],
    ['finishing', 'day.js', 'if (this.#unfinished && this.#timeline) this.#fill(this.#key);', NOTHING],
  ],
  'a time-lapse that waits for a busy daemon is stopped at once': [
    ['the end of the wait', 'task.js', 'onWait, signal);', 'onWait);'],
    ['the end of the words when stopped', 'day.js', `this.#say('');\n    } catch`, '} catch'],
    ['the end of the words when it plays', 'day.js', `if (!at) this.#say('');`, NOTHING],
  ],
  'a day that is pressed twice plays once': [
    ['one at a time', 'day.js', 'if (this.#playing) return this.#lapse.stop();', 'if (this.#lapse.running) return this.#lapse.stop();'],
  ],
  'a longitude beyond 180 degrees has its day too': [
    ['east and west', 'day.js', 'eastOrWest(known(longitude, PLACES[0][2]))', 'known(longitude, PLACES[0][2])'],
  ],
  'a time-lapse plays in any page, in an <img>': [['the stream', 'v1/stream']],

  // ---- Frames ---------------------------------------------------------------------------------

  'frames follow the hand, small, and sharpen when it rests': [
    ['small frames', 'view.js', 'return { ...this.#sizeUpTo(this.#movingPixels), moving: true };', 'return { ...this.fullSize(), moving: true };'],
    ['frames while the hand moves', 'view.js', 'if (restsIn > 0 && fresh) {', 'if (restsIn > 0 && this.facts) {'],
    ['sharpening', 'view.js', 'if (this.#shown.pixels >= full) return undefined;', 'if ((this.wasSharp ||= this.#shown.pixels >= full)) return undefined;'],
  ],
  'a slider dragged for ten seconds leaves no request and no error behind': [
    ['one request at a time', 'view.js', 'if (this.#flight && !this.#mayAbandon(now)) return;\n    const size = this.#nextSize(now);\n    if (!size) return;\n    this.#abandon(now);',
     'const size = this.#nextSize(now);\n    if (!size) return;'],
    ['asking for what there is', 'view.js', `image: { ...image, width, height, format: 'png' } };`, `image: { ...image, width, height, format: this.facts && moving ? 'gif' : 'png' } };`],
  ],
  'the frame says its speed, method, options, error and exposure': [
    ['the device time', 'facts.js', `['Render', `, `['', `],
    ['the method', 'facts.js', `['Method', `, `['', `],
    ['the options', 'facts.js', `['Options', `, `['', `],
    ['the error', 'facts.js', `['Error', `, `['', `],
    ['the exposure', 'facts.js', `['Exposure', `, `['', `],
    ['frames per second', 'facts.js', 'facts.moving || framesPerSecond > 4', 'false'],
    ['what its error means', 'facts.js', 'A bound meant to hold in 95 % of frames', NOTHING],
    ['what its exposure means', 'facts.js', 'Stops; at 0 a white card facing the sun outside the air is 1', NOTHING],
  ],

  // ---- Compare --------------------------------------------------------------------------------

  'a wipe shows the same sky by another method': [
    ['the other method', 'compare.js', ': { ...scene, method: { name: this.against.value, scattering_orders: scene.method?.scattering_orders } };', ': scene;'],
    ['the cut', 'wipe.js', 'this.other.style.clipPath = `inset(0 0 0 ${percent})`;', NOTHING],
    ['dragging the line', 'wipe.js', 'this.#move((event.clientX - box.left) / box.width);', NOTHING],
    ['keys on the line', 'wipe.js', 'this.#move(this.#share + STEP[event.key]);', NOTHING],
  ],
  'another method is compared in as many orders as the scene has': [
    ['the orders', 'compare.js', ', scattering_orders: scene.method?.scattering_orders } };', ' } };'],
  ],
  'a pinned sky is wiped against what was changed': [
    ['pinning', 'compare.js', 'this.#pinned = this.state.document();', 'this.#pinned = { preset: this.state.preset };\n    Object.defineProperty(this.#pinned, \'sun\', { enumerable: true, get: () => this.state.document().sun });'],
    ['going back to one sky', 'wipe.js', 'hide() {\n    this.handle.hidden = this.other.hidden = true;', 'hide() {\n    this.handle.hidden = true;'],
  ],
  'the error picture shows where they differ, with a scale': [
    ['the picture', 'overlay.js', 'this.context.drawImage(bitmap, -(bitmap.width - width) / 2, 0);', NOTHING],
    ['its scale', 'compare.js', 'this.place.append(scale);', NOTHING],
    ['figures', 'compare.js', 'this.place.replaceChildren(figuresTable(figures));', NOTHING],
    ['hiding it when the sky changes', 'compare.js', 'this.other.change();\n    this.overlay.hide();', 'this.other.change();'],
  ],
  'where the method falls short in this sky is told, and where the measurements are': [
    ['the note', 'limits.js', 'this.note.hidden = !limits.length || this.view.facts?.method !== method;', 'this.note.hidden = true;'],
    ['the limits', 'limits.js', `h('ul', {}, limits.map((text) => h('li', {}, text))),`, NOTHING],
    ['the measurements', 'failures.html'],
  ],
  'what each part is worth is told in bars, and how far the work is': [
    ['bars', 'worked.js', 'put(draw(found), scene);', NOTHING],
    ['their order', 'explain.js', '.sort(([, a], [, b]) => b.error - a.error)', NOTHING],
    ['progress', 'worked.js', 'done.value = share;', NOTHING],
  ],
  'what is measured is by the method of the frame on screen': [
    ['attributions by it', 'attribute.js', '(scene) => view.asShown(scene)', '(scene) => scene'],
    ['figures by it', 'compare.js', 'const a = sized(this.view.asShown(this.state.document()));', 'const a = sized(this.state.document());'],
    ['figures against its', 'compare.js', 'const b = sized(this.other.asShown(this.#otherScene()));', 'const b = sized(this.#otherScene());'],
  ],
  'a result of an earlier sky says so': [
    ['the words', 'stale.js', `else if (!words) place.prepend(h('p', { className: 'stale-words' }, 'Of the sky as it was before.'));`, NOTHING],
    ['what was worked out', 'worked.js', 'place.replaceChildren(element);\n    mark();', 'place.replaceChildren(element);'],
    ['what was charted', 'chart.js', 'this.#mark();\n    this.#age();', 'this.#mark();'],
    ['another change', 'worked.js', `state.addEventListener('change', mark);`, NOTHING],
  ],
  'who stopped waiting for a busy daemon and asks again sees the work of the second question': [
    ['whose work it is', 'worked.js', 'if (!found) return;  // it was stopped, and the next may be under way\n      put(draw(found), scene);', 'if (found) put(draw(found), scene);'],
    ['progress after a wait', 'worked.js', 'if (!waiting.isConnected) put(waiting);', NOTHING],
    ['a chart that stops at once', 'chart.js', 'this.#task.stop();\n    this.#end();', 'this.#task.stop();'],
  ],
  'where the error of the chosen method comes from is told in bars': [
    ['the method', 'attribute.js', '[title, settings]', '[title]'],
    ['bars', 'attribute.js', `bars('Error by cause', rows),`, NOTHING],
    ['their order', 'attribute.js', '.sort((a, b) => b.error - a.error)', NOTHING],
  ],
  'speed and accuracy are charted while they are measured; a point is taken': [
    ['points as they come', 'chart.js', 'this.#redraw = undefined;\n      this.#draw();', 'this.#redraw = undefined;\n      if (!this.#task.running) this.#draw();'],
    ['the Pareto front', 'chart.js', 'const front = paretoFront(this.#points);', 'const front = [];'],
    ['stopping', 'chart.js', 'if (this.#task.running) return this.#stop();', 'if (this.#task.running) return undefined;'],
    ['click to choose', 'chart.js', `dot.addEventListener('click', choose);`, NOTHING],
    ['keys to choose', 'chart.js', `if (event.key !== 'Enter' && event.key !== ' ') return;`, 'return;'],
    ['the mark of what is chosen', 'chart.js', `dot.setAttribute('aria-pressed', String(dot.dataset.point === keyOf({ method: name, options })));`, NOTHING],
  ],
  'an EXR that is dropped is judged against the sky': [
    ['dropping', 'own.js', 'curtain.hidden = true;\n      this.#take(event.dataTransfer.files[0]);', 'curtain.hidden = true;'],
    ['the curtain', 'own.js', 'curtain.hidden = false;', NOTHING],
    ['figures', 'own.js', 'if (figures) this.#put(title, figuresTable(figures));', NOTHING],
    ['its error picture', 'own.js', `const ask = mode === 'air' ? composite : judgeAsPicture;`, 'const ask = () => undefined;'],
    ['the way back', 'own.js', 'onclick: () => {\n      this.#putAway();', 'onclick: () => {'],
  ],
  'a picture of one’s own is put away in any state, and gives way to the next': [
    ['the way back', 'own.js', 'this.modes.element.hidden = this.back.hidden = false;', 'this.modes.element.hidden = false;'],
    ['where the keys go on', 'own.js', 'this.input.focus();', NOTHING],
    ['forgetting it', 'own.js', '#putAway() {\n    this.#task.stop();\n    this.#file = undefined;', '#putAway() {\n    this.#task.stop();'],
    ['giving way', 'own.js', '#putAway() {\n    this.#task.stop();', '#putAway() {'],
  ],
  'a picture of one’s own gives way to a comparison': [
    ['giving way', 'own.js', `if (this.#file) this.#putAway();`, NOTHING],
  ],
  'a picture with distances gets the air of the sky': [
    ['the air', 'own.js', `this.modes.choose(hasAir ? 'air' : 'figures');`, `this.modes.choose('figures');`],
  ],
  'an EXR is chosen where none can be dropped': [
    ['choosing', 'own.js', 'onchange: () => this.#take(this.input.files[0])', NOTHING],
  ],
  'what is no EXR is said in words': [
    ['the words', 'own.js', 'return this.#say(error.message);', 'return undefined;'],
  ],

  // ---- The probe ------------------------------------------------------------------------------

  'a pixel tells its spectrum, colour, luminance, transmittance and error': [
    ['pointing', 'probe.js', 'if (this.#active()) this.#point(detail);', NOTHING],
    ['the spectrum', 'probe.js', `series: [{ name: 'Radiance', points: along(light), kind: 'main' }] }),`, 'series: [] }),'],
    ['the colour', 'probe.js', `['Colour', [swatch, shown ?? 'outside the picture']],`, NOTHING],
    ['the luminance', 'probe.js', `['Luminance', `, `['', `],
    ['the transmittance', 'probe.js', `series: [{ name: 'Transmittance', points: along(clear), kind: 'second' }] }),`, 'series: [] }),'],
    ['the error', 'probe.js', `['Error', `, `['', `],
    ['the ring', 'probe.js', 'this.mark.style.left = `${spot.x}px`;', NOTHING],
    ['the ring that stays with its direction', 'probe.js', 'const pixel = toPixel(direction(elevation, azimuth), this.#camera, width, height);',
     'const pixel = toPixel(direction(elevation, azimuth), (this.still ??= { ...this.#camera }), width, height);'],
  ],
  'light of a sky that has changed behind the folded controls is asked for anew': [
    ['saying so', 'probe.js', 'if (this.#target) markStale(this.place, true);', 'if (this.#target && this.#active()) markStale(this.place, true);'],
    ['telling of the fold', 'panel.js', `classList.toggle('folded', !open);\n    tell();`, `classList.toggle('folded', !open);`],
  ],
  'a plot reads its values off by keys': [
    ['keys on a plot', 'plot.js', 'show(chosen + step * (event.shiftKey ? 10 : 1));', NOTHING],
    ['P for the middle', 'page.js', `event.key.toLowerCase() === 'p') this.probe.middle();`, `event.key.toLowerCase() === 'p') ;`],
  ],
  'a panorama is probed where it is pointed at': [
    ['its margins', 'probe.js', 'fromPixel({ x: x - left, y: y - top },', 'fromPixel({ x, y },'],
  ],

  // ---- Skies, history, what is taken away -----------------------------------------------------

  'presets are thumbnails that the daemon has rendered': [
    ['thumbnails', 'presets.js', 'image.src = address;', NOTHING],
    ['taking one', 'presets.js', 'onclick: () => state.load({ preset: preset.name, patch: {} }),', NOTHING],
  ],
  'undo and redo': [
    ['undo', 'page.js', `byId('undo').addEventListener('click', () => state.undo());`, NOTHING],
    ['redo', 'page.js', `byId('redo').addEventListener('click', () => state.redo());`, NOTHING],
    ['their keys', 'page.js', 'if (event.shiftKey) this.state.redo();\n      else this.state.undo();', NOTHING],
  ],
  'a link is the scene, and back goes back': [
    ['reading the link', 'main.js', 'new State(readLink(location.hash))', `new State(readLink('#preset=mars'))`],
    ['writing it', 'link.js', `history.pushState({}, '', linkOf(state.snapshot()));`, NOTHING],
    ['going back', 'link.js', 'if (!equal(linked, state.snapshot())) state.load(linked);', NOTHING],
  ],
  'JSON, link, curl and Python make the same frame': [
    ['copying', 'dom.js', 'await navigator.clipboard.writeText(text);', NOTHING],
    ['JSON', 'link.js', 'JSON: (state) => JSON.stringify(state.document(), null, 2),', 'JSON: ({ preset }) => JSON.stringify({ preset }),'],
    ['the link', 'link.js', `location.href.split('#')[0] + linkOf(state.snapshot()),`, `location.href.split('#')[0] + String(state.preset),`],
    ['curl', 'link.js', 'JSON.stringify(state.document()))}\'', 'JSON.stringify({}))}\''],
    ['Python', 'link.js', 'file.write(answer.read())', 'pass'],
  ],
  'PNG and EXR are downloaded at a chosen size': [
    ['saving', 'dom.js', `h('a', { href: address, download: name }).click();`, NOTHING],
    ['the size', 'save.js', 'const size = () => ({ width: columns(), height: pixels(height) });', 'const size = () => ({ width: 64, height: 36 });'],
    ['EXR', 'save.js', `title: 'OpenEXR, linear light', image: { format: 'exr' }`, `title: 'OpenEXR, linear light', image: { format: 'png' }`],
  ],
  'an EXR has its layers apart, an environment map is a whole sphere': [
    ['layers', 'save.js', '...(apart.length ? { layers: apart } : {}),', NOTHING],
    ['the sphere', 'save.js', `image: { format: 'hdr' }, camera: SPHERE }`, `image: { format: 'hdr' } }`],
    ['even widths', 'save.js', '2 * Math.ceil(pixels(width) / 2)', 'pixels(width)'],
    ['HDR', 'save.js', `title: 'Environment map, HDR', image: { format: 'hdr' }`, `title: 'Environment map, HDR', image: { format: 'png' }`],
  ],

  // ---- Troubles -------------------------------------------------------------------------------

  'a busy daemon is asked again when it says': [
    ['the words', 'api.js', 'return `The daemon is busy; trying again in ${error.retryAfterSeconds} s.`;', `return '';`],
    ['the wait', 'view.js', 'this.#retryAt = performance.now() + waitMs(error, ++this.#attempts);', 'this.#retryAt = performance.now() + 100;'],
    ['asking again', 'retry.js', 'error instanceof Busy || error instanceof Gone;', 'error instanceof Gone;'],
  ],
  'a daemon that went away comes back without a reload': [
    ['the words', 'api.js', `if (error instanceof Gone) return 'The daemon does not answer; trying again.';`, `if (error instanceof Gone) return '';`],
    ['asking again', 'retry.js', 'error instanceof Busy || error instanceof Gone;', 'error instanceof Busy;'],
  ],
  'a refusal is shown beside its control, under the last good picture': [
    ['its place', 'main.js', 'const beside = error.pointer && page?.controls?.complain(fromPointer(error.pointer), error.message);', 'const beside = false;'],
    ['the last good picture', 'main.js', `view.addEventListener('refused', ({ detail }) => sayRefused(detail));`,
     `view.addEventListener('refused', ({ detail }) => { sayRefused(detail); view.context.transferFromImageBitmap(null); });`],
    ['its end', 'main.js', `page?.controls?.forgive();`, NOTHING],
  ],

  'a refusal whose control is not seen is told over the picture': [
    ['looking whether it is', 'controls.js', 'return nearest?.element.checkVisibility() ?? false;', 'return nearest !== undefined;'],
    ['unfolding', 'controls.js', 'if (message) this.#unfold();', NOTHING],
  ],

  // ---- Manners --------------------------------------------------------------------------------

  'what is asked names the atmosphere that the last answer was for': [
    ['naming it', 'api.js', `...(atmosphere && { 'Cyanometer-Atmosphere': atmosphere })`, NOTHING],
  ],
  'all of the page comes from the daemon': [
    ['keeping to it', 'main.js', `bindAddress(state);`, `bindAddress(state);\nfetch('https://example.org/').catch(() => {});`],
  ],
  'it is accessible in the light': [
    ['contrast', 'style.css', '--quiet: #47525e;', '--quiet: #aab5c1;'],
    ['names of buttons', 'index.html', 'aria-label="Undo" title="Undo (Ctrl+Z)"', NOTHING],
    ['contrast of what is off', 'style.css', '.card.off .name { color: var(--quiet); }', '.card.off .name { opacity: 0.5; }'],
    ['contrast of what is old', 'style.css', '.stale { opacity: 0.85;', '.stale { opacity: 0.45;'],
    ['edges of sliders', 'style.css', 'margin-top: -6px;\n  border: 0;\n  border-radius: 50%;\n  background: #fff;\n  box-shadow: 0 0 0 1.5px var(--quiet);',
     'margin-top: -6px;\n  border: 0;\n  border-radius: 50%;\n  background: #fff;'],
    ['edges of switches', 'style.css', 'box-shadow: inset 0 0 0 1.5px var(--quiet);', NOTHING],
  ],
  'what is on is seen in forced colours': [
    ['tabs', 'style.css', ', [role=tab][aria-selected=true], .segmented button[aria-pressed=true]) {\n    forced', ', .segmented button[aria-pressed=true]) {\n    forced'],
    ['choices of a few', 'style.css', ', .segmented button[aria-pressed=true]) {\n    forced', ') {\n    forced'],
    ['switches', 'style.css', '.chip, .switch, [role=tablist]', '.chip, [role=tablist]'],
  ],
  'it is accessible in the dark': [
    ['contrast', 'style.css', '--quiet: #aab5c1;', '--quiet: #47525e;'],
    ['the dark', 'style.css', '@media (prefers-color-scheme: dark) {\n  :root {', '@media print {\n  :root {'],
    ['names of sliders', 'editors.js', `step: scale.logarithmic ? 1 : 'any',\n    'aria-label': binding.label,`, `step: scale.logarithmic ? 1 : 'any',`],
  ],
};

export const BREAKAGES = Object.entries(BY_SENTENCE).flatMap(([sentence, all]) =>
  all.map(([without, file, text, instead, size]) => ({ sentence, without, file, text, instead, size })));
