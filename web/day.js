// A place and a time: a strip of the day, from dawn to dusk, rendered by the daemon as a stream of
// small frames; the sun's height drawn over it; and a time-lapse of the picture itself.

import { day, inWords, stream } from './api.js';
import { h, icon, svg } from './dom.js';
import { number } from './editors.js';
import { Task } from './task.js';

const PLACES = [
  ['Paris', 48.85, 2.35], ['Quito', -0.18, -78.47], ['Cape Town', -33.92, 18.42], ['Sydney', -33.87, 151.21],
  ['Tokyo', 35.68, 139.69], ['Mauna Kea', 19.82, -155.47], ['Tromsø', 69.65, 18.96],
  ['South Pole', -90, 0],
];
const SLICES = 18;
const SLICE_PX = { width: 32, height: 96 };
const LAPSE_FRAMES = 120;
const WIDTH = 312;
const HEIGHT = 84;
const DAY_MS = 86400e3;
const MINUTE_MS = 60e3;

const today = () => new Date().toISOString().slice(0, 10);
// The sun's own hour at a longitude, to whole hours: clocks of states are not known here.
const offsetMinutes = (longitude) => 60 * Math.round(longitude / 15);

function offsetText(minutes) {
  const two = (value) => String(value).padStart(2, '0');
  const size = Math.abs(minutes);
  return `${minutes < 0 ? '-' : '+'}${two(Math.floor(size / 60))}:${two(size % 60)}`;
}
const clock = (time) => time.slice(11, 16);

export class Day {
  #day;      // the answer of /v1/day
  #key = ''; // what the strip shows
  #asked = new Task();
  #slices = new Task();
  #lapse = new Task();
  #drawn = 0;

  constructor({ state, view, idle, fold }) {
    Object.assign(this, { state, view, idle, fold });
    const angle = (label, limit, name) => number(
      { minimum: -limit, maximum: limit, 'x-unit': 'deg', type: 'number' },
      { label, get: () => this.#place()[name],
        set: (value) => this.#move({ [name]: Math.min(limit, Math.max(-limit, value)) }), complain: (text) => this.#say(text) });
    this.latitude = angle('Latitude', 90, 'latitude_deg');
    this.longitude = angle('Longitude', 180, 'longitude_deg');
    this.places = h('select', { 'aria-label': 'Place', onchange: () => {
      const [, latitude, longitude] = PLACES[this.places.selectedIndex - 1];
      this.#move({ latitude_deg: latitude, longitude_deg: longitude });
    } }, h('option', { value: '', disabled: true }, 'A place…'), PLACES.map(([name]) => h('option', {}, name)));
    this.date = h('input', { type: 'date', min: '1900-01-02', max: '2100-12-30', 'aria-label': 'Date',
                             onchange: () => { if (this.date.value) this.#move({ date: this.date.value }); } });
    this.canvas = h('canvas', { width: SLICES * SLICE_PX.width, height: SLICE_PX.height });
    this.drawing = svg('svg', { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: 'none', 'aria-hidden': 'true' });
    this.slider = h('input', { type: 'range', min: 0, max: 1000, step: 1, className: 'moment',
                               'aria-label': 'Time of day', oninput: () => this.#choose(Number(this.slider.value) / 1000) });
    this.marks = h('div', { className: 'strip-marks', 'aria-hidden': 'true' });
    this.now = h('output', { className: 'strip-now' });
    this.play = h('button', { type: 'button', className: 'chip with-icon', onclick: () => this.#press() });
    this.words = h('p', { className: 'help', role: 'status' });
    this.element = h('div', { className: 'day' },
      h('div', { className: 'row' }, this.places, this.date),
      ...[['Latitude', this.latitude], ['Longitude', this.longitude]].map(([title, one]) =>
        h('div', { className: 'control' }, h('div', { className: 'head' }, h('span', { className: 'title' }, title)), one.element)),
      h('div', { className: 'strip' }, this.canvas, this.drawing, this.slider), this.marks,
      h('div', { className: 'row' }, this.now, this.play), this.words);
    this.#label(false);
    state.addEventListener('change', () => {
      if (this.#lapse.running) this.#lapse.stop();
      this.#show();
    });
    for (const event of ['settle', 'resolve']) state.addEventListener(event, () => this.#refresh());
  }

  /** The fold has been opened. */
  opened() {
    this.#refresh();
  }

  // The scene's, or where somebody would start from.
  #place() {
    const { latitude_deg: latitude, longitude_deg: longitude, time } =
      this.state.document().sun?.place ?? this.started ?? {};
    const place = { latitude_deg: latitude ?? PLACES[0][1], longitude_deg: longitude ?? PLACES[0][2] };
    const offset = offsetMinutes(place.longitude_deg);
    const moment = time ? new Date(time) : new Date(`${today()}T12:00:00${offsetText(offset)}`);
    const local = new Date(moment.getTime() + offset * MINUTE_MS).toISOString();
    return { ...place, offset, date: local.slice(0, 10), clock: local.slice(11, 19), set: time !== undefined };
  }

  // Sets the scene's place and time; the clock keeps its hour.
  #move(change) {
    const { latitude_deg, longitude_deg, date, clock: hour } = { ...this.#place(), ...change };
    const offset = offsetText(offsetMinutes(longitude_deg));
    this.state.edit({ 'sun.place': { latitude_deg, longitude_deg, time: `${date}T${hour}${offset}` } });
  }

  // ---- The strip ----------------------------------------------------------------------------

  async #refresh() {
    this.#show();
    if (!this.fold().open || !this.element.checkVisibility()) return;
    const { latitude_deg, longitude_deg, date, offset } = this.#place();
    const asked = { latitude_deg, longitude_deg, date, utc_offset_min: offset };
    const { sun, method, ...rest } = this.state.document();
    const key = JSON.stringify([asked, rest]);
    if (key === this.#key) return;
    this.#key = key;
    try {
      const answer = await this.#asked.run((signal) => day(asked, signal), (error) => this.#say(inWords(error)));
      if (!answer) return;
      this.#day = answer;
      this.#say('');
      this.#show();
      await this.#fill(key);
    } catch (error) {
      this.#key = '';
      this.#say(inWords(error));
    }
  }

  // From dawn to dusk; where there are none, from midnight to midnight.
  #ends() {
    const { dawn, dusk, moments } = this.#day;
    const ends = [dawn ?? moments[0].time, dusk ?? moments.at(-1).time].map((time) => Date.parse(time));
    return ends[1] > ends[0] ? ends : [ends[0], ends[0] + DAY_MS];
  }
  #timeAt(share) {
    const [from, to] = this.#ends();
    const { offset } = this.#place();
    const moment = new Date(from + share * (to - from) + offset * MINUTE_MS).toISOString().slice(0, 19);
    return moment + offsetText(offset);
  }
  #shareOf(time) {
    const [from, to] = this.#ends();
    return (Date.parse(time) - from) / (to - from);
  }
  #patchAt(share) {
    const { latitude_deg, longitude_deg } = this.#place();
    return { sun: { place: { latitude_deg, longitude_deg, time: this.#timeAt(share) } } };
  }

  // Small frames of this view through the day, behind the frame on screen.
  async #fill(key) {
    await this.idle();
    if (key !== this.#key) return;
    const { image, method, sun, ...scene } = this.state.document();
    const { elevation_deg, azimuth_deg, place, ...light } = sun ?? {};
    const { channels, layers, ...look } = image ?? {};
    const small = { ...scene, sun: light, method: { max_error: 0.1, max_ms: 40 },
                    image: { ...look, ...SLICE_PX, format: 'png' },
                    camera: { ...scene.camera, projection: 'perspective', fov_deg: 70 } };
    const context = this.canvas.getContext('2d');
    const frames = Array.from({ length: SLICES }, (_, i) => this.#patchAt((i + 0.5) / SLICES));
    await this.#slices.run((signal) => stream(small, frames, async (blob, facts, at) => {
      const bitmap = await createImageBitmap(blob);
      if (!signal.aborted) context.drawImage(bitmap, at * SLICE_PX.width, 0);
      this.canvas.dataset.slices = String(at + 1);
      bitmap.close();
    }, signal), (error) => this.#say(inWords(error)));
  }

  #show() {
    const place = this.#place();
    this.latitude.refresh();
    this.longitude.refresh();
    if (document.activeElement !== this.date) this.date.value = place.date;
    const known = PLACES.findIndex(([, latitude, longitude]) =>
      latitude === place.latitude_deg && longitude === place.longitude_deg);
    this.places.selectedIndex = known + 1;
    if (!this.#day) return;
    const share = this.#shareOf(`${place.date}T${place.clock}${offsetText(place.offset)}`);
    this.#point(Math.min(1, Math.max(0, share)), place.set && share >= 0 && share <= 1);
    this.#draw();
  }

  // The moment that the slider names; faint where the scene's sun has no place and time.
  #point(share, set) {
    this.slider.value = Math.round(1000 * share);
    this.slider.style.setProperty('--at', String(share));
    this.slider.classList.toggle('unset', !set);
    const time = this.#timeAt(share);
    this.slider.setAttribute('aria-valuetext', `${clock(time)}${set ? '' : ', not chosen yet'}`);
    const { offset } = this.#place();
    const zone = `UTC${offset ? `${offset < 0 ? '−' : '+'}${Math.abs(offset / 60)}` : ''}`;
    this.now.textContent = set ? `${clock(time)} ${zone}, sun ${this.#elevationAt(time)}` : 'Drag along the strip';
  }
  #elevationAt(time) {
    const { moments } = this.#day;
    const place = (Date.parse(time) - Date.parse(moments[0].time)) / (10 * MINUTE_MS);
    const [before, after] = [moments[Math.floor(place)], moments[Math.ceil(place)]];
    if (!before || !after) return '';
    const t = place - Math.floor(place);
    const elevation = (1 - t) * before.elevation_deg + t * after.elevation_deg;
    return `${elevation.toFixed(1).replace('-', '−')}°`;
  }

  #draw() {
    const { moments, sunrise, sunset, highest } = this.#day;
    const [low, high] = [-8, 92];
    const y = (elevation) => HEIGHT * (1 - (elevation - low) / (high - low));
    const line = moments.map(({ time, elevation_deg: elevation }) => [this.#shareOf(time) * WIDTH, y(elevation)])
      .filter(([x]) => x >= -20 && x <= WIDTH + 20)
      .map(([x, at], i) => `${i ? 'L' : 'M'}${x.toFixed(1)} ${at.toFixed(1)}`).join('');
    this.drawing.replaceChildren(
      svg('line', { x1: 0, x2: WIDTH, y1: y(0), y2: y(0), class: 'horizon' }),
      svg('path', { d: line, class: 'height' }));
    const named = [[sunrise, 'sunrise'], [highest.time, 'noon'], [sunset, 'sunset']].filter(([time]) => time);
    this.marks.replaceChildren(...named.map(([time, name]) => {
      const mark = h('span', { title: name }, `${name === 'noon' ? 'highest' : name} ${clock(time)}`);
      mark.style.setProperty('--at', String(this.#shareOf(time)));
      return mark;
    }));
  }

  #choose(share) {
    this.state.edit({ 'sun.place': this.#patchAt(share).sun.place });
  }

  // ---- The time-lapse -----------------------------------------------------------------------

  #label(playing) {
    this.play.replaceChildren(icon(playing ? 'stop' : 'play'), playing ? 'Stop' : 'Play the day');
    this.play.disabled = false;
  }

  async #press() {
    if (this.#lapse.running) return this.#lapse.stop();
    await this.#refresh();
    if (!this.#day) return;
    this.#slices.stop();
    const { sun, ...scene } = this.view.movingScene();
    const { elevation_deg, azimuth_deg, place, ...light } = sun ?? {};
    const shares = Array.from({ length: LAPSE_FRAMES }, (_, i) => i / (LAPSE_FRAMES - 1));
    let last;
    this.#label(true);
    this.view.hold();
    try {
      await this.#lapse.run((signal) => stream({ ...scene, sun: light }, shares.map((share) => this.#patchAt(share)),
        async (blob, facts, at) => {
          const bitmap = await createImageBitmap(blob);
          if (signal.aborted) return;
          last = shares[at];
          this.view.present(bitmap, facts);
          this.#point(last, true);
        }, signal), (error) => this.#say(inWords(error)));
    } catch (error) {
      this.#say(inWords(error));
    }
    this.#label(false);
    if (last !== undefined) this.#choose(last);
    this.view.release();
  }

  #say(text) {
    this.words.textContent = text;
  }
}
