// Hands on the picture: drag to look, drag the sun, wheel and pinch to zoom, keys to fly. A press
// that does not move is a `tap` (detail: {x, y}) of the canvas.

import { angles, direction, fromPixel, horizonDipDeg, toPixel, wrapDegrees } from './projection.js';

const SUN_GRIP_PX = { mouse: 18, touch: 34, pen: 24 };
const STILL_PX = 5;
const WIDEST = { perspective: 150, fisheye: 360 };
const NARROWEST_DEG = 1;
const FLATTEST_DEG = 179;  // a perspective of 180 would be infinitely wide
const LOWEST_KM = 0.001;
const HIGHEST_KM = 1e6;

const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
const tidy = (value, digits = 6) => Number(value.toPrecision(digits));
const degrees = (value) => Number(value.toFixed(3));

export class Camera {
  #pointers = new Map();
  #pressed;  // where a single pointer went down, until it moves
  #grip;  // what the hand holds: 'look', 'sun' or 'pinch'

  constructor(canvas, state) {
    this.canvas = canvas;
    this.state = state;
    canvas.addEventListener('pointerdown', (event) => this.#down(event));
    canvas.addEventListener('pointermove', (event) => this.#move(event));
    for (const end of ['pointerup', 'pointercancel']) {
      canvas.addEventListener(end, (event) => this.#up(event));
    }
    canvas.addEventListener('wheel', (event) => this.#wheel(event), { passive: false });
  }

  get #camera() {
    return this.state.value('camera') ?? {};
  }
  get #fovDeg() {
    return this.#camera.fov_deg ?? (this.#projection === 'fisheye' ? 180 : 60);
  }
  get #projection() {
    return this.#camera.projection ?? 'perspective';
  }

  // ---- Pointers -----------------------------------------------------------------------------

  #down(event) {
    this.canvas.focus({ preventScroll: true });
    this.canvas.setPointerCapture(event.pointerId);
    this.#pointers.set(event.pointerId, this.#spot(event));
    this.#pressed = this.#pointers.size > 1 ? undefined : this.#spot(event);
    this.#grip = this.#pointers.size > 1 ? 'pinch' : this.#isOnSun(event) ? 'sun' : 'look';
    this.canvas.dataset.grip = this.#grip;
  }

  #move(event) {
    const before = this.#pointers.get(event.pointerId);
    const now = this.#spot(event);
    if (!before) {
      this.canvas.classList.toggle('on-sun', this.#isOnSun(event));
      return;
    }
    const { x, y } = this.#pressed ?? before;
    if (this.#pressed && Math.hypot(now.x - x, now.y - y) < STILL_PX) return;
    this.#pressed = undefined;
    const gap = this.#gap();
    this.#pointers.set(event.pointerId, now);
    if (this.#grip === 'pinch') this.zoom(gap / this.#gap());
    else if (this.#grip === 'sun') this.#moveSun(now);
    else this.#drag(now.x - before.x, now.y - before.y);
  }

  #up(event) {
    this.#pointers.delete(event.pointerId);
    if (this.#pressed && event.type === 'pointerup') {
      this.canvas.dispatchEvent(new CustomEvent('tap', { detail: this.#pressed }));
    }
    this.#pressed = undefined;
    this.#grip = this.#pointers.size ? 'look' : undefined;
    if (!this.#grip) delete this.canvas.dataset.grip;
  }

  #wheel(event) {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 16 : 1;
    this.zoom(Math.exp(clamp(event.deltaY * lines, -200, 200) * 0.0012));
  }

  #spot(event) {
    const box = this.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }
  #gap() {
    const [a, b] = [...this.#pointers.values()];
    return b ? Math.max(1, Math.hypot(a.x - b.x, a.y - b.y)) : 1;
  }

  // The sky follows the hand.
  #drag(dx, dy) {
    const perPixel = (this.#projection === 'perspective' ? this.#fovDeg : 180) /
      this.canvas.clientHeight;
    const pitch = this.#camera.pitch_deg ?? 0;
    const narrowing = Math.max(0.2, Math.cos((pitch * Math.PI) / 180));
    this.look((-dx * perPixel) / narrowing, dy * perPixel);
  }

  // ---- The sun ------------------------------------------------------------------------------

  #isOnSun(event) {
    const spot = this.sunSpot();
    const { x, y } = this.#spot(event);
    return spot !== undefined &&
      Math.hypot(spot.x - x, spot.y - y) < (SUN_GRIP_PX[event.pointerType] ?? 18) + spot.radius;
  }

  /** Where the sun is in the picture: {x, y, radius} in CSS pixels, undefined where it is not. */
  sunSpot() {
    const sun = this.state.value('sun');
    if (!sun || sun.elevation_deg === undefined || this.#projection !== 'perspective') return undefined;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const spot = toPixel(direction(sun.elevation_deg, sun.azimuth_deg ?? 0), this.#camera, width, height);
    if (!spot || spot.x < 0 || spot.y < 0 || spot.x > width || spot.y > height) return undefined;
    return { ...spot, radius: ((sun.angular_diameter_deg ?? 0.533) / this.#fovDeg) * height * 0.5 };
  }

  #moveSun(spot) {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const { elevationDeg, azimuthDeg } = angles(fromPixel(spot, this.#camera, width, height));
    this.placeSun(elevationDeg, azimuthDeg);
  }

  /** Puts the sun at angles. */
  placeSun(elevationDeg, azimuthDeg) {
    this.#edit({ 'sun.elevation_deg': degrees(clamp(elevationDeg, -90, 90)),
                 'sun.azimuth_deg': degrees(wrapDegrees(azimuthDeg)) });
  }

  // ---- Moves --------------------------------------------------------------------------------

  // A move starts from where things are, which must be known.
  #edit(members) {
    if (this.state.isKnown()) this.state.edit(members);
  }

  look(headingDeg, pitchDeg) {
    const { heading_deg: heading = 0, pitch_deg: pitch = 0 } = this.#camera;
    this.#edit({ 'camera.heading_deg': degrees(wrapDegrees(heading + headingDeg)),
                 'camera.pitch_deg': degrees(clamp(pitch + pitchDeg, -90, 90)) });
  }

  zoom(factor) {
    const widest = WIDEST[this.#projection];
    if (!widest) return;
    this.#edit({ 'camera.fov_deg': tidy(clamp(this.#fovDeg * factor, NARROWEST_DEG, widest)) });
  }

  /** What an edit of `path` brings along: who climbs keeps the horizon where it is in the picture. */
  companions(path, value) {
    const { altitude_km: altitude, pitch_deg: pitch } = this.#camera;
    const radius = this.state.value('planet.radius_km');
    if (path !== 'camera.altitude_km' || ![value, altitude, pitch, radius].every(Number.isFinite)) return {};
    const sunk = horizonDipDeg(value, radius) - horizonDipDeg(altitude, radius);
    return { 'camera.pitch_deg': degrees(clamp(pitch - sunk, -90, 90)) };
  }

  /** The most that a slider of `path` reaches here. */
  most(path) {
    return path === 'camera.fov_deg' && this.#projection === 'perspective' ? FLATTEST_DEG : Infinity;
  }

  climb(factor) {
    const altitude = this.#camera.altitude_km ?? 0;
    const next = clamp(Math.max(altitude, LOWEST_KM) * factor, LOWEST_KM, HIGHEST_KM);
    const edit = { 'camera.altitude_km': tidy(next, 4) };
    this.#edit({ ...edit, ...this.companions('camera.altitude_km', edit['camera.altitude_km']) });
  }

  #raiseSun(byDeg) {
    const { elevation_deg: elevation = 30, azimuth_deg: azimuth = 0 } = this.state.value('sun') ?? {};
    this.placeSun(elevation + byDeg, azimuth);
  }

  #home() {
    this.state.edit({ 'camera.heading_deg': undefined, 'camera.pitch_deg': undefined,
                      'camera.roll_deg': undefined, 'camera.fov_deg': undefined,
                      'camera.altitude_km': undefined });
  }

  /** Does what a key stands for; false where it stands for nothing here. */
  key(event) {
    const step = this.#fovDeg / (event.shiftKey ? 8 : 40);
    const moves = {
      ArrowLeft: () => this.look(-step, 0), ArrowRight: () => this.look(step, 0),
      ArrowUp: () => this.look(0, step), ArrowDown: () => this.look(0, -step),
      '+': () => this.zoom(1 / 1.08), '=': () => this.zoom(1 / 1.08), '-': () => this.zoom(1.08),
      w: () => this.climb(1.15), s: () => this.climb(1 / 1.15),
      d: () => this.#raiseSun(0.5), a: () => this.#raiseSun(-0.5), 0: () => this.#home(),
    };
    const move = moves[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    move?.();
    return move !== undefined;
  }
}
