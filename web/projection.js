// Where a direction falls in a picture, and back. Local frame: x east, y north, z up.

const RADIANS = Math.PI / 180;

/** Unit vector of an elevation and an azimuth (clockwise from north). */
export function direction(elevationDeg, azimuthDeg) {
  const [e, a] = [elevationDeg * RADIANS, azimuthDeg * RADIANS];
  return [Math.cos(e) * Math.sin(a), Math.cos(e) * Math.cos(a), Math.sin(e)];
}

/** How far the horizon of a sphere lies below the horizontal, in degrees. */
export const horizonDipDeg = (altitudeKm, radiusKm) =>
  Math.acos(radiusKm / (radiusKm + Math.max(0, altitudeKm))) / RADIANS;

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

const along = ({ forward, right, up }, x, y, z) =>
  mix(mix(right, x, up, y), 1, forward, z);

// {right, up, ahead}: a direction in the camera's own frame.
function seen(vector, camera) {
  const { forward, right, up } = axes(camera);
  return { right: dot(vector, right), up: dot(vector, up), ahead: dot(vector, forward) };
}

// A pixel's ray and a ray's pixel for each projection; `width` and `height` are the picture's. What
// lies outside the picture is undefined.
const PROJECTIONS = {
  perspective: {
    toPixel({ right, up, ahead }, camera, width, height) {
      if (ahead <= 1e-6) return undefined;
      const focal = scale(camera, height) / ahead;
      return { x: width / 2 + focal * right, y: height / 2 - focal * up };
    },
    fromPixel: ({ x, y }, camera, width, height) => {
      const focal = scale(camera, height);
      return [(x - width / 2) / focal, (height / 2 - y) / focal, 1];
    },
  },
  // Equidistant: the angle from the axis grows evenly, to half the field of view at the circle.
  fisheye: {
    toPixel({ right, up, ahead }, camera, width, height) {
      const sine = Math.hypot(right, up);
      const half = ((camera.fov_deg ?? 180) * RADIANS) / 2;
      const angle = Math.atan2(sine, ahead);
      if (angle > half) return undefined;
      const radius = ((angle / half) * Math.min(width, height)) / 2;
      const [c, s] = sine > 0 ? [right / sine, up / sine] : [0, 0];
      return { x: width / 2 + radius * c, y: height / 2 - radius * s };
    },
    fromPixel({ x, y }, camera, width, height) {
      const [dx, dy] = [x - width / 2, height / 2 - y];
      const share = (2 * Math.hypot(dx, dy)) / Math.min(width, height);
      if (share > 1) return undefined;
      const angle = (share * (camera.fov_deg ?? 180) * RADIANS) / 2;
      const length = Math.hypot(dx, dy) || 1;
      const sine = Math.sin(angle);
      return [(dx / length) * sine, (dy / length) * sine, Math.cos(angle)];
    },
  },
  equirectangular: {
    toPixel: ({ right, up, ahead }, camera, width, height) => ({
      x: width * (0.5 + Math.atan2(right, ahead) / (2 * Math.PI)),
      y: height * (0.5 - Math.asin(Math.min(1, Math.max(-1, up))) / Math.PI),
    }),
    fromPixel({ x, y }, camera, width, height) {
      const [longitude, latitude] = [(x / width - 0.5) * 2 * Math.PI, (0.5 - y / height) * Math.PI];
      return [Math.cos(latitude) * Math.sin(longitude), Math.sin(latitude),
              Math.cos(latitude) * Math.cos(longitude)];
    },
  },
  // OpenGL's faces +X -X +Y -Y +Z -Z from the top; the camera's right, up and back are its axes.
  cubemap: {
    toPixel({ right, up, ahead }, camera, width, height) {
      const [x, y, z] = [right, up, -ahead];
      const [ax, ay, az] = [x, y, z].map(Math.abs);
      const [face, s, t, major] = ax >= ay && ax >= az ? (x > 0 ? [0, -z, -y, ax] : [1, z, -y, ax])
        : ay >= az ? (y > 0 ? [2, x, z, ay] : [3, x, -z, ay])
                   : z > 0 ? [4, x, -y, az] : [5, -x, -y, az];
      const side = height / 6;
      return { x: (width * (s / major + 1)) / 2, y: side * (face + (t / major + 1) / 2) };
    },
    fromPixel({ x, y }, camera, width, height) {
      const face = Math.min(5, Math.max(0, Math.floor((6 * y) / height)));
      const [s, t] = [(2 * x) / width - 1, 2 * ((6 * y) / height - face) - 1];
      const [gx, gy, gz] = [[1, -t, -s], [-1, -t, s], [s, 1, t], [s, -1, -t], [s, -t, 1],
                            [-s, -t, -1]][face];
      return [gx, gy, -gz];
    },
  },
};

const projectionOf = (camera) => PROJECTIONS[camera.projection ?? 'perspective'];

/** Pixel {x, y} of a direction in a picture of `width` x `height`; undefined where it has none. */
export const toPixel = (vector, camera, width, height) =>
  projectionOf(camera).toPixel(seen(vector, camera), camera, width, height);

/** The direction that a pixel shows; undefined outside the picture. */
export function fromPixel(pixel, camera, width, height) {
  const local = projectionOf(camera).fromPixel(pixel, camera, width, height);
  if (!local) return undefined;
  const ray = along(axes(camera), ...local);
  const length = Math.sqrt(dot(ray, ray));
  return ray.map((value) => value / length);
}

/** The same heading between -180 and 180 degrees. */
export const wrapDegrees = (degrees) => ((((degrees + 180) % 360) + 360) % 360) - 180;
