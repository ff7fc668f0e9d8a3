// The scene as the device sees it. C++ includes this file too (engine/physics/physics.h), with Real as float
// for the upload and as double for the oracle, so the two can't drift apart. Members come in
// groups of 16 bytes, so that std430 and C++ agree on every offset.

struct SceneData {
  Real planet_radius_km;
  Real thickness_km;
  Real camera_altitude_km;
  Real sun_distance_km;  // from the planet's centre; 0 is parallel light

  Vec4 camera_right;    // local frame: x east, y north, z up at the camera's foot point
  Vec4 camera_up;
  Vec4 camera_forward;
  Vec4 sun_direction;   // to the centre of the disc, seen from the foot point
  Vec4 sun_position;    // km, the planet's centre at the origin; idle for parallel light

  Real tan_half_fov;    // perspective: of half the vertical angle
  Real half_fov_rad;    // fisheye: half of the full circle
  Real sun_sin_radius;  // sine of the disc's angular radius at the foot point
  Real sun_foot_km;     // distance of a near sun from the foot point

  int width;
  int height;
  int disc_points;
  int kinks;            // altitudes at which profiles bend, behind the rules (quadrature.glsl)

  Real view_scale_km;   // height over which what scatters thins out (raymarch.glsl)
  int ends;             // of rays: 1 for all, or one a ray (camera.glsl)
  Real pixel_rad;       // angle that a pixel of the frame spans, near its middle
  int surface;          // what the ground is (surface/data.glsl); 0 is the same everywhere

  int layers;           // 1 where one may hide what lies behind it, as clouds do (raymarch.glsl)
  int projection;       // PROJECTION_*
  int idle[2];
};

// One constituent; `a` and `b` by type of profile (profile.glsl), `g` by type of phase (phase.glsl).
struct MediumData {
  Real a;
  Real b;
  Real g;
  int phase;
  int profile_node;    // first node of a tabulated profile, and their number
  int profile_nodes;
  int phase_node;      // first node of a tabulated phase, and their number
  int phase_nodes;
};

// What phase.glsl tells apart.
CONSTANT int PHASE_NONE = 0;
CONSTANT int PHASE_RAYLEIGH = 1;
CONSTANT int PHASE_HENYEY_GREENSTEIN = 2;
CONSTANT int PHASE_CORNETTE_SHANKS = 3;
CONSTANT int PHASE_TABLE = 4;

// What camera.glsl tells apart.
CONSTANT int PROJECTION_PERSPECTIVE = 0;
CONSTANT int PROJECTION_FISHEYE = 1;
CONSTANT int PROJECTION_EQUIRECTANGULAR = 2;
CONSTANT int PROJECTION_CUBEMAP = 3;
CONSTANT int PROJECTION_LIST = 4;  // directions from a buffer
