// A day as the daemon tells it, as a line from dawn to dusk.

const DAY_MS = 86400e3;
const MINUTE_MS = 60e3;
const STEP_MS = 10 * MINUTE_MS;  // between the daemon's moments

/** The sun's own hour at a longitude, to whole hours: the clocks of states are not known here. */
export const offsetMinutes = (longitude) => 60 * Math.round(longitude / 15);

/** As in RFC 3339. */
export function offsetText(minutes) {
  const two = (value) => String(value).padStart(2, '0');
  const size = Math.abs(minutes);
  return `${minutes < 0 ? '-' : '+'}${two(Math.floor(size / 60))}:${two(size % 60)}`;
}

export class Timeline {
  /** @param day  the answer of /v1/day, told by a clock `offset` minutes ahead of UTC */
  constructor(day, offset) {
    this.day = day;
    this.offset = offset;
    // Where there is no dawn or dusk, from midnight to midnight.
    const { dawn, dusk, moments } = day;
    const [from, to] = [dawn ?? moments[0].time, dusk ?? moments.at(-1).time].map((time) => Date.parse(time));
    this.from = from;
    this.length = to > from ? to - from : DAY_MS;
  }

  timeAt(share) {
    const moment = new Date(this.from + share * this.length + this.offset * MINUTE_MS);
    return moment.toISOString().slice(0, 19) + offsetText(this.offset);
  }
  shareOf(time) {
    return (Date.parse(time) - this.from) / this.length;
  }

  /** In words: { clock, zone, elevation }. */
  at(share) {
    const time = this.timeAt(share);
    const hours = Math.abs(this.offset / 60);
    const elevation = this.#elevationAt(Date.parse(time));
    return { clock: time.slice(11, 16),
             zone: `UTC${hours ? `${this.offset < 0 ? '−' : '+'}${hours}` : ''}`,
             elevation: `${elevation.toFixed(1).replace('-', '−')}°` };
  }
  #elevationAt(moment) {
    const { moments } = this.day;
    const place = Math.min(moments.length - 1, Math.max(0, (moment - Date.parse(moments[0].time)) / STEP_MS));
    const [before, after] = [moments[Math.floor(place)], moments[Math.ceil(place)]];
    const t = place - Math.floor(place);
    return (1 - t) * before.elevation_deg + t * after.elevation_deg;
  }
}
