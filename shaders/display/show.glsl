// Linear light to what 8 bits hold, for the passes that show pixels.
#define Real float
#define Vec3 vec3
#define Vec4 vec4
#define CONSTANT const
#include "display/tone.glsl"

layout(constant_id = 0) const int TONE_MAP = 0;
layout(constant_id = 1) const bool PAINT_CLIPPED = false;

float greatest(vec3 v) { return max(v.x, max(v.y, v.z)); }

// Whether a colour is too bright to be shown. No grey comes out of AgX as white, however bright: there it is
// one beyond the curve's range. The other two that reach no end show as white in 8 bits what is near enough.
bool clips(vec3 rgb, vec3 shown) {
  if (greatest(shown) > 1.0) return true;
  if (TONE_MAP == TONE_AGX) return greatest(agx_inset(rgb)) > exp2(AGX_MOST_EV);
  bool endless = TONE_MAP == TONE_REINHARD || TONE_MAP == TONE_EXPONENTIAL;
  return endless && srgb_encoded(greatest(shown)) * 255.0 >= 254.5;
}

// sRGB, 0 to 255, of light to which exposure and white balance have been applied.
vec3 levels_of(vec3 linear) {
  vec3 rgb = into_gamut(linear);
  vec3 shown = tone_mapped(TONE_MAP, rgb);
  if (PAINT_CLIPPED && clips(rgb, shown)) return vec3(255.0, 0.0, 255.0);
  shown = clamp(shown, 0.0, 1.0);
  return 255.0 * vec3(srgb_encoded(shown.x), srgb_encoded(shown.y), srgb_encoded(shown.z));
}
