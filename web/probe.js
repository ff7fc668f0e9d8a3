// The probe: what light comes from the direction under a pixel. Its spectrum, colour, luminance,
// transmittance and error, as the daemon computes them along that ray.

import { inWords, radiance } from './api.js';
import { h } from './dom.js';
import { percent } from './figures.js';
import { format } from './numbers.js';
import { equal } from './paths.js';
import { linePlot } from './plot.js';
import { angles, direction, fromPixel, toPixel, wrapDegrees } from './projection.js';
import { markStale } from './stale.js';
import { Task } from './task.js';
import { words } from './editors.js';

const significant = (value, digits = 3) => format(Number(value.toPrecision(digits))).replace('-', '−');

export class Probe {
  #task = new Task();
  #target;  // {elevation_deg, azimuth_deg}

  /** `panel` opens the tab and says whether it is seen; `mark` is the ring on the picture. */
  constructor({ state, view, panel, mark }) {
    Object.assign(this, { state, view, panel, mark });
    this.place = h('div', { className: 'result', 'aria-live': 'polite' });
    this.element = h('div', { className: 'block' }, h('h2', {}, 'Light from a direction'),
      h('p', { className: 'help' }, 'Click or tap the picture. P on the keyboard probes its middle.'),
      this.place);
    view.canvas.addEventListener('tap', ({ detail }) => { if (this.#active()) this.#point(detail); });
    state.addEventListener('change', () => {
      this.#follow();
      if (this.#target) markStale(this.place, true);
    });
    state.addEventListener('settle', () => this.#ask());
    view.addEventListener('frame', () => this.#follow());
    const tab = document.getElementById('probe');
    tab.addEventListener('shown', () => {
      view.canvas.classList.add('probing');
      this.#follow();
      this.#ask();
    });
    tab.addEventListener('hidden', () => {
      view.canvas.classList.remove('probing');
      this.#task.stop();
      this.#follow();
    });
  }

  #active() {
    return this.panel.showing('probe');
  }
  get #camera() {
    return this.state.value('camera') ?? {};
  }

  /** Probes the middle of the picture. */
  middle() {
    this.panel.select('probe');
    const { clientWidth, clientHeight } = this.view.canvas;
    this.#point({ x: clientWidth / 2, y: clientHeight / 2 });
  }

  #point({ x, y }) {
    const { left, top, width, height } = this.view.pictureBox();
    const ray = fromPixel({ x: x - left, y: y - top }, this.#camera, width, height);
    if (!ray || x < left || y < top || x > left + width || y > top + height) {
      this.#say('There is no picture there.');
      return;
    }
    const { elevationDeg, azimuthDeg } = angles(ray);
    this.#target = { elevation_deg: Number(elevationDeg.toFixed(4)),
                     azimuth_deg: Number(wrapDegrees(azimuthDeg).toFixed(4)) };
    this.#follow();
    this.#ask();
  }

  // The ring stays on its direction while the camera turns.
  #follow() {
    const spot = this.#spot();
    this.mark.hidden = !spot || !this.#active();
    if (!spot) return;
    this.mark.style.left = `${spot.x}px`;
    this.mark.style.top = `${spot.y}px`;
  }
  #spot() {
    if (!this.#target) return undefined;
    const { left, top, width, height } = this.view.pictureBox();
    const { elevation_deg: elevation, azimuth_deg: azimuth } = this.#target;
    const pixel = toPixel(direction(elevation, azimuth), this.#camera, width, height);
    if (!pixel || pixel.x < 0 || pixel.y < 0 || pixel.x > width || pixel.y > height) return undefined;
    return { x: left + pixel.x, y: top + pixel.y };
  }

  async #ask() {
    if (!this.#target || !this.#active()) return;
    const asked = this.state.document();
    const { image, ...scene } = asked;
    try {
      const answer = await this.#task.run((signal) => radiance(scene, [this.#target], signal),
                                          (error) => this.#say(inWords(error)));
      if (!answer) return;
      this.#put(this.#draw(answer), !equal(asked, this.state.document()));
    } catch (error) {
      this.#say(inWords(error));
    }
  }
  #say(text) {
    this.#put([h('p', { className: 'help' }, text)], false);
  }
  #put(elements, stale) {
    this.place.replaceChildren(...elements);
    markStale(this.place, stale);
  }

  #draw(answer) {
    const { wavelengths_nm: wavelengths, radiance: [light], transmittance: [clear] } = answer;
    const unit = this.state.value('sun.irradiance') === 1 ? '1/sr' : 'W m⁻² sr⁻¹ nm⁻¹';
    const along = (values) => wavelengths.map((wavelength, i) => [wavelength, values[i]])
      .sort(([a], [b]) => a - b);
    const x = { title: 'wavelength', unit: 'nm' };
    return [
      this.#facts(answer),
      h('h3', {}, 'Spectrum'),
      linePlot({ label: 'Spectral radiance against wavelength', x,
                 y: { title: 'radiance', unit, low: 0 },
                 series: [{ name: 'Radiance', points: along(light), kind: 'main' }] }),
      h('h3', {}, 'Transmittance'),
      linePlot({ label: 'Transmittance against wavelength', x, y: { title: 'transmittance', low: 0, high: 1 },
                 series: [{ name: 'Transmittance', points: along(clear), kind: 'second' }] }),
    ];
  }

  #facts({ error, method, luminance_cd_m2: luminance, rgb: [rgb], standard_error: noise }) {
    const { elevation_deg: elevation, azimuth_deg: azimuth } = this.#target;
    const shown = this.#colourOnScreen();
    const swatch = h('span', { className: 'swatch' });
    if (shown) swatch.style.backgroundColor = shown;
    const rows = [
      ['Direction', `${significant(elevation)}° up, ${significant((azimuth + 360) % 360)}° from north`],
      ['Colour', [swatch, shown ?? 'outside the picture']],
      ['Linear R, G, B', rgb.map((value) => significant(value)).join(', ')],
      ['Luminance', luminance ? `${significant(luminance[0])} cd/m²` : 'none: the channels are radiances'],
      ['Error', `≤ ${percent(error)}`],
      ['Method', `${words(method)}${noise ? ', with noise' : ''}`],
    ];
    return h('dl', { className: 'figures' }, rows.map(([name, value]) =>
      h('div', { 'data-figure': name }, h('dt', {}, name), h('dd', {}, value))));
  }

  // As it is displayed, disc and stars included.
  #colourOnScreen() {
    const spot = this.#spot();
    const { canvas } = this.view;
    if (!spot || !canvas.width) return undefined;
    const { left, top, width, height } = this.view.pictureBox();
    const copy = new OffscreenCanvas(1, 1).getContext('2d');
    const column = Math.min(canvas.width - 1, Math.floor(((spot.x - left) / width) * canvas.width));
    const row = Math.min(canvas.height - 1, Math.floor(((spot.y - top) / height) * canvas.height));
    copy.drawImage(canvas, -column, -row);
    const [r, g, b] = copy.getImageData(0, 0, 1, 1).data;
    return `#${[r, g, b].map((value) => value.toString(16).padStart(2, '0')).join('')}`;
  }
}
