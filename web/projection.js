// Where a direction falls in a perspective picture, and back. Local frame: x east, y north, z up.

const RADIANS = Math.PI / 180;

/** Unit vector of an elevation and an azimuth (clockwise from north). */
export function direction(elevationDeg, azimuthDeg) {
  const [e, a] = [elevationDeg * RADIANS, azimuthDeg * RADIANS];
  return [Math.cos(e) * Math.sin(a), Math.cos(e) * Math.cos(a), Math.sin(e)];
}

/** The inverse of `direction`. */
export function angles([x, y, z]) {
  return { elevationDeg: Math.atan2(z, Math.hypot(x, y)) / RADIANS,
           azimuthDeg: Math.atan2(x, y) / RADIANS };
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const mix = (a, s, b, t) => a.map((value, i) => s * value + t * b[i]);

// Right, up and forward of a camera; positive roll turns it clockwise seen from behind.
function axes({ heading_deg: heading = 0, pitch_deg: pitch = 0, roll_deg: roll = 0 }) {
  const forward = direction(pitch, heading);
  const right = direction(0, heading + 90);
  const up = direction(pitch + 90, heading);
  const [c, s] = [Math.cos(roll * RADIANS), Math.sin(roll * RADIANS)];
  return { forward, right: mix(right, c, up, -s), up: mix(up, c, right, s) };
}

const scale = (camera, height) => height / (2 * Math.tan(((camera.fov_deg ?? 60) * RADIANS) / 2));

/** Pixel {x, y} of a direction in a picture of `width` x `height`; undefined behind the camera. */
export function toPixel(vector, camera, width, height) {
  const { forward, right, up } = axes(camera);
  const depth = dot(vector, forward);
  if (depth <= 1e-6) return undefined;
  const focal = scale(camera, height) / depth;
  return { x: width / 2 + focal * dot(vector, right), y: height / 2 - focal * dot(vector, up) };
}

/** The direction that a pixel shows. */
export function fromPixel({ x, y }, camera, width, height) {
  const { forward, right, up } = axes(camera);
  const focal = scale(camera, height);
  const ray = mix(mix(forward, 1, right, (x - width / 2) / focal), 1, up, (height / 2 - y) / focal);
  const length = Math.sqrt(dot(ray, ray));
  return ray.map((value) => value / length);
}

/** The same heading between -180 and 180 degrees. */
export const wrapDegrees = (degrees) => ((((degrees + 180) % 360) + 360) % 360) - 180;
