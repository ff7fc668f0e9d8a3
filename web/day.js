// A place and a time: the sun of a day somewhere, chosen on a strip, and a time-lapse of the picture.

import { day, inWords, stream } from './api.js';
import { offsetMinutes, offsetText, Timeline } from './day_clock.js';
import { DayStrip } from './day_strip.js';
import { h, icon } from './dom.js';
import { number } from './editors.js';
import { equal } from './paths.js';
import { wrapDegrees } from './projection.js';
import { Task } from './task.js';

const PLACES = [
  ['Paris', 48.85, 2.35], ['Quito', -0.18, -78.47], ['Cape Town', -33.92, 18.42],
  ['Sydney', -33.87, 151.21], ['Tokyo', 35.68, 139.69], ['Mauna Kea', 19.82, -155.47],
  ['Tromsø', 69.65, 18.96], ['South Pole', -90, 0],
];
const LAPSE_FRAMES = 120;
const MINUTE_MS = 60e3;

/** East or west of Greenwich, as days are asked for: scenes may go all the way round. */
const eastOrWest = (longitude) =>
  (Math.abs(longitude) > 180 ? Number(wrapDegrees(longitude).toFixed(6)) : longitude);

const today = () => new Date().toISOString().slice(0, 10);

/** A moment by a clock `offset` minutes ahead of UTC, as ISO text without it; undefined where `time` is no time. */
function clockText(time, offset) {
  const local = new Date(Date.parse(time) + offset * MINUTE_MS);
  const text = Number.isNaN(local.getTime()) ? '' : local.toISOString();
  return /^\d/.test(text) ? text : undefined;  // not thousands of years from now
}

/** The scene without what says where its sun is: frames say that themselves. */
function withoutSun({ sun, ...scene }) {
  const { elevation_deg, azimuth_deg, place, ...light } = sun ?? {};
  return { ...scene, sun: light };
}

export class Day {
  #timeline;  // of the day on the strip, once that is known
  #dayKey = '';  // which day that is
  #key = '';  // what the strip shows
  #known;  // resolves when its day is known, or cannot be
  #unfinished = false;  // of its slices some are missing
  #asked = new Task();
  #lapse = new Task();
  #playing = false;  // from the press on, before the lapse begins and until its last word

  /** `idle()` resolves when the frame on screen does not need the daemon; `fold()` holds this. */
  constructor({ state, view, idle, fold }) {
    Object.assign(this, { state, view, idle, fold });
    this.strip = new DayStrip((share) => this.#choose(share), (text) => this.#say(text));
    this.now = h('output', { className: 'strip-now' });
    this.play = h('button', { type: 'button', className: 'chip with-icon', onclick: () => this.#press() });
    this.words = h('p', { className: 'help', role: 'status' });
    this.element = h('div', { className: 'day' }, this.#placeControls(), this.strip.element,
      h('div', { className: 'row' }, this.now, this.play), this.words);
    this.#label(false);
    state.addEventListener('change', () => {
      if (this.#lapse.running) this.#lapse.stop();
      this.#show();
    });
    for (const event of ['settle', 'resolve']) state.addEventListener(event, () => this.refresh());
  }

  // ---- Where and when -------------------------------------------------------------------------

  #placeControls() {
    this.places = h('select', { 'aria-label': 'Place', onchange: () => {
      const [, latitude, longitude] = PLACES[this.places.selectedIndex - 1];
      this.#move({ latitude_deg: latitude, longitude_deg: longitude });
    } }, h('option', { value: '', disabled: true }, 'A place…'), PLACES.map(([name]) => h('option', {}, name)));
    this.date = h('input', { type: 'date', min: '1900-01-02', max: '2100-12-30', 'aria-label': 'Date',
                             onchange: () => { if (this.date.value) this.#move({ date: this.date.value }); } });
    this.angles = [this.#angle('Latitude', 90, 'latitude_deg'), this.#angle('Longitude', 180, 'longitude_deg')];
    return h('div', {}, h('div', { className: 'row' }, this.places, this.date),
             this.angles.map(({ row }) => row));
  }
  #angle(title, limit, name) {
    const editor = number({ type: 'number', minimum: -limit, maximum: limit, 'x-unit': 'deg' }, {
      label: title,
      get: () => this.#place()[name],
      set: (value) => this.#move({ [name]: Math.min(limit, Math.max(-limit, value)) }),
      complain: (text) => this.#say(text),
    });
    const head = h('div', { className: 'head' }, h('span', { className: 'title' }, title));
    return { ...editor, row: h('div', { className: 'control' }, head, editor.element) };
  }

  // The scene's, or where somebody would start from: noon of today in the first place.
  #place() {
    const { latitude_deg: latitude, longitude_deg: longitude, time } = this.state.document().sun?.place ?? {};
    const known = (angle, usual) => (Number.isFinite(angle) ? angle : usual);  // a link may say anything
    const place = { latitude_deg: known(latitude, PLACES[0][1]),
                    longitude_deg: eastOrWest(known(longitude, PLACES[0][2])) };
    const offset = offsetMinutes(place.longitude_deg);
    const set = clockText(time, offset);
    const local = set ?? `${today()}T12:00:00`;
    return { ...place, offset, date: local.slice(0, 10), clock: local.slice(11, 19), set: set !== undefined };
  }

  // Sets the scene's place and time; the clock keeps its hour.
  #move(change) {
    const { latitude_deg, longitude_deg, date, clock } = { ...this.#place(), ...change };
    const time = `${date}T${clock}${offsetText(offsetMinutes(longitude_deg))}`;
    this.state.edit({ 'sun.place': { latitude_deg, longitude_deg, time } });
  }
  #placeAt(share) {
    const { latitude_deg, longitude_deg } = this.#place();
    return { latitude_deg, longitude_deg, time: this.#timeline.timeAt(share) };
  }
  #choose(share) {
    if (this.#timeline) this.state.edit({ 'sun.place': this.#placeAt(share) });
  }

  // ---- The strip ------------------------------------------------------------------------------

  /** Looks whether the strip is seen and still shows the scene; resolves when it is known which day that is. */
  refresh() {
    this.#show();
    if (!this.fold().open || !this.element.checkVisibility()) return this.#known;
    const { latitude_deg, longitude_deg, date, offset } = this.#place();
    const asked = { latitude_deg, longitude_deg, date, utc_offset_min: offset };
    const { sun, method, ...rest } = this.state.document();
    const key = JSON.stringify([asked, rest]);
    if (key === this.#key) return this.#known;
    this.#key = key;
    const dayKey = JSON.stringify(asked);
    if (dayKey !== this.#dayKey) this.#timeline = undefined;
    this.#dayKey = dayKey;
    this.#known = this.#ask(asked, key);
    return this.#known;
  }
  async #ask(asked, key) {
    this.#unfinished = true;
    try {
      const answer = await this.#asked.run((signal) => day(asked, signal), (error) => this.#say(inWords(error)));
      if (!answer) return;
      this.#timeline = new Timeline(answer, asked.utc_offset_min);
      this.#say('');
      this.#show();
      this.#fill(key);
    } catch (error) {
      this.#refused(error);
    }
  }
  async #fill(key) {
    await this.idle();
    if (key !== this.#key || this.#playing) return;
    try {
      const done = await this.strip.fill(withoutSun(this.state.document()),
                                         (share) => ({ sun: { place: this.#placeAt(share) } }));
      if (done) this.#unfinished = false;
    } catch (error) {
      this.#refused(error);
    }
  }
  #refused(error) {
    this.#key = '';
    this.#say(inWords(error));
  }

  #show() {
    const place = this.#place();
    this.angles.forEach((one) => one.refresh());
    if (document.activeElement !== this.date) this.date.value = place.date;
    this.places.selectedIndex = 1 + PLACES.findIndex(([, latitude, longitude]) =>
      latitude === place.latitude_deg && longitude === place.longitude_deg);
    if (!this.#timeline) return;
    const share = this.#timeline.shareOf(`${place.date}T${place.clock}${offsetText(place.offset)}`);
    this.strip.draw(this.#timeline);
    this.#point(Math.min(1, Math.max(0, share)), place.set && share >= 0 && share <= 1);
  }

  // The moment that the slider names; faint where the scene's sun has no place and time.
  #point(share, set) {
    const { clock, zone, elevation } = this.#timeline.at(share);
    this.strip.point(share, set, clock);
    this.now.textContent = set ? `${clock} ${zone}, sun ${elevation}` : 'Drag along the strip';
  }

  // ---- The time-lapse -------------------------------------------------------------------------

  #label(playing) {
    this.play.replaceChildren(icon(playing ? 'stop' : 'play'), playing ? 'Stop' : 'Play the day');
  }

  async #press() {
    if (this.#playing) return this.#lapse.stop();
    this.#playing = true;
    try {
      await this.refresh();
      if (this.#timeline) await this.#playOn();
    } finally {
      this.#playing = false;
      if (this.#unfinished && this.#timeline) this.#fill(this.#key);  // the strip gave way to the lapse
    }
  }

  // Where the day ends is chosen, unless the person has chosen something else meanwhile.
  async #playOn() {
    this.strip.stop();
    this.#label(true);
    this.view.hold();
    const before = this.state.snapshot();
    const last = await this.#run(withoutSun(this.view.movingScene()));
    this.#label(false);
    if (last !== undefined && equal(before, this.state.snapshot())) this.#choose(last);
    this.view.release();
  }

  // Shows frame after frame; returns how far the day went.
  async #run(scene) {
    const shareAt = (i) => i / (LAPSE_FRAMES - 1);
    const frames = Array.from({ length: LAPSE_FRAMES }, (_, i) => ({ sun: { place: this.#placeAt(shareAt(i)) } }));
    let last;
    try {
      await this.#lapse.run((signal) => stream(scene, frames, async (blob, facts, at) => {
        const bitmap = await createImageBitmap(blob);
        if (signal.aborted) return bitmap.close();
        if (!at) this.#say('');  // the daemon may have been busy
        last = shareAt(at);
        this.view.present(bitmap, facts);
        this.#point(last, true);
      }, signal), (error) => this.#say(inWords(error)));
      this.#say('');
    } catch (error) {
      this.#say(inWords(error));
    }
    return last;
  }

  #say(text) {
    this.words.textContent = text;
  }
}
