// Numbers on sliders and in words.

/** Four significant digits, without an exponent where a person would not write one. */
export function format(value) {
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size < 1e-4 || size >= 1e7) return value.toExponential(3).replace(/\.?0+e\+?/, 'e');
  return String(Number(value.toPrecision(size >= 1000 ? 6 : 4)));
}

// To some this comma is a decimal point, to others it parts the thousands.
const AMBIGUOUS = /^[+-]?\d+,\d{3}$/;
const plain = (text) => text.trim().replace('−', '-');

/** The number a person has typed, undefined where it is none. A comma is a decimal point too. */
export function parse(text) {
  const typed = plain(text);
  if (typed === '' || AMBIGUOUS.test(typed)) return undefined;
  const value = Number(typed.replace(/^([+-]?\d+),(\d+)$/, '$1.$2'));
  return Number.isFinite(value) ? value : undefined;
}

/** What is wrong with a text that is no number, for a person. */
export function whyNoNumber(text) {
  const typed = plain(text);
  if (!AMBIGUOUS.test(typed)) return 'This needs a number.';
  return `Is this ${typed.replace(',', '')} or ${typed.replace(',', '.')}? Write it without the comma.`;
}

const UNITS = { deg: '°', um: 'µm', '1/km': 'km⁻¹', 'W m^-2 nm^-1': 'W m⁻² nm⁻¹' };
export const unitText = (unit) => UNITS[unit] ?? unit ?? '';

const POSITIONS = 1000;

/** The scale of a slider: positions 0 to `positions` against values. */
export class Scale {
  constructor(node) {
    const slider = node['x-slider'] ?? {};
    this.low = slider.minimum ?? node.minimum ?? 0;
    this.high = slider.maximum ?? node.maximum ?? 1;
    this.allowed = [node.minimum ?? -Infinity, node.maximum ?? Infinity];
    this.integer = node.type === 'integer';
    this.logarithmic = slider.scale === 'log' && this.high > 0;
    // A logarithmic scale that starts at 0 shows eight decades, and 0 itself at its very left.
    this.zero = this.logarithmic && this.low <= 0;
    if (this.zero) this.low = this.high * 1e-8;
    this.step = slider.step || (this.integer ? 1 : (this.high - this.low) / POSITIONS);
    this.positions = this.logarithmic ? POSITIONS
                                      : Math.max(1, Math.round((this.high - this.low) / this.step));
  }

  toPosition(value) {
    if (this.zero && value <= 0) return 0;
    const share = this.logarithmic ? Math.log(value / this.low) / Math.log(this.high / this.low)
                                   : (value - this.low) / (this.high - this.low);
    return Math.min(this.positions, Math.max(0, share * this.positions));
  }

  toValue(position) {
    const share = position / this.positions;
    if (!this.logarithmic) return this.#tidy(this.low + position * this.step);
    if (this.zero && position <= 0) return 0;
    return this.#tidy(Number((this.low * (this.high / this.low) ** share).toPrecision(3)));
  }

  /** `value` after so many steps, which may lead beyond the slider but not beyond what is allowed. */
  stepped(value = this.low, steps) {
    const [least, most] = this.allowed;
    const next = this.logarithmic ? this.#byFactors(value, steps) : value + steps * this.step;
    const whole = this.integer ? awayFrom(value, Math.round(next), steps) : Number(next.toPrecision(9));
    return Math.min(most, Math.max(least, whole));
  }
  #byFactors(value, steps) {
    const factor = (this.high / this.low) ** (steps / this.positions);
    if (this.zero && value * factor < this.low) return steps > 0 ? this.low : 0;
    return Number((value * factor).toPrecision(4));
  }

  #tidy(value) {
    const inside = Math.min(this.high, Math.max(this.low, value));
    return this.integer ? Math.round(inside) : Number(inside.toPrecision(9));
  }
}

// A step of a whole number is one at least.
const awayFrom = (value, next, steps) => (next === value ? value + Math.sign(steps) : next);
