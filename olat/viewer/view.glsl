// The picture of a state, pixel by pixel: what olat/pair/picture.cc computes, in the browser. Photo and render are two
// textures of one call and pass the same uniforms, so their exposure and their view cannot differ. tests/olat/view holds
// both against each other.
//
// A program is built for what is on: VIEW_<NAME>, and where they are on OVERLAY (1 zones, 2 curve), ZEBRA, WEDGE, ONION
// METRIC (its index, 5 for maps that are given), RENDER (nothing else is shown), PANES (some pixels are photo, some
// render), FLAWS (they are looked at) and MINIFIED (a texel is less than a pixel). Software GL runs every branch of a
// program for every pixel, so one for all would cost ten times as much.
precision highp float;
precision highp int;
precision highp sampler2D;

uniform sampler2D photo, render, flip;  // half floats; A of photo: the bits of its flaws
uniform bool has_photo, has_render, has_flip;
uniform vec2 canvas;      // [pixel]
uniform vec2 size;        // of the picture [pixel]
uniform vec2 origin;      // of the picture in its pane, whole [pixel]
uniform float zoom;       // canvas pixels for a pixel of the picture
uniform float pane_width; // [pixel]; two panes if it is less than the canvas
uniform int mode, channel;
uniform float wedge;      // height of the strip of greys [pixel]; 0: none
uniform float split, onion, range, noise, exposure;
uniform vec3 gain;        // of the render
uniform float gt[6];      // P a m l c b
uniform vec2 limits;      // of the curve: end of the toe, start of the shoulder
uniform vec3 zone_colors[17], signed_colors[5], magma[18];
uniform vec3 toe_color, shoulder_color, sensor_stripe, display_stripe;
uniform float surround, grey, grey_zone;
out vec4 color;

const int kSide = 3;  // of mode
const int kClipped = 1, kNotFinite = 4, kMasked = 8;
const float kLeastNoise = 1.17549435e-38;

float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }

float srgb_encode(float x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055; }
float srgb_decode(float y) { return y <= 0.04045 ? y / 12.92 : pow((y + 0.055) / 1.055, 2.4); }
vec3 srgb_encode(vec3 c) { return vec3(srgb_encode(c.r), srgb_encode(c.g), srgb_encode(c.b)); }

// brdf/lighting/gt_tonemap.h
float gt_curve(float x) {
  float P = gt[0], a = gt[1], m = gt[2], l = gt[3], c = gt[4], b = gt[5];
  float start = m + (P - m) * l / a, room = (P - m) * (1.0 - l);
  float line = m + a * (x - m);
  if (x < m) {
    float t = x / m, w = t * t * (3.0 - 2.0 * t);
    return max((1.0 - w) * (m * (t > 0.0 ? pow(t, c) : 0.0) + b) + w * line, 0.0);
  }
  if (x <= start) return line;
  return room > 1e-30 ? P - room * exp(-a * (x - start) / room) : P;
}

// render/view/khronos_neutral.h
vec3 khronos(vec3 c) {
  float x = min(c.r, min(c.g, c.b));
  c -= x <= 0.08 ? x - x * x / 0.16 : 0.04;
  float peak = max(c.r, max(c.g, c.b));
  if (peak <= 0.76) return c;
  float low = 1.0 - 0.0576 / (peak - 0.52);
  float kept = 1.0 / (0.15 * (peak - low) + 1.0);
  return c * (low / peak) * kept + low * (1.0 - kept);
}

// render/view/agx.h
float agx_sigmoid(float t) {
  const float p = 10.0 / 16.5;
  bool below = t < p;
  float k = below ? 3.0 : 3.25, reach = below ? p : 1.0 - p;
  float scale = (pow(4.0 * reach, k) - 1.0) / pow(reach, k), d = t - p;
  float power = d == 0.0 ? 0.0 : pow(abs(d), k);
  return 0.5 + 2.0 * d / pow(1.0 + scale * power, 1.0 / k);
}
vec3 agx(vec3 c) {
  const mat3 inset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051, 0.0784335999999992,
                          0.878468636469772, 0.0784336, 0.0792237451477643, 0.0791661274605434, 0.879142973793104);
  const mat3 outset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438, -0.0980208811401368,
                           1.15190312990417, -0.0980434501171241, -0.0990297440797205, -0.0989611768448433,
                           1.15107367264116);
  vec3 t = clamp((log2(max(inset * c, 1e-10) / 0.18) + 10.0) / 16.5, 0.0, 1.0);
  return clamp(outset * vec3(agx_sigmoid(t.r), agx_sigmoid(t.g), agx_sigmoid(t.b)), 0.0, 1.0);
}

// Light to display values in [0, 1]: exposure, then the view that this program was built with.
vec3 shown(vec3 light) {
  vec3 c = light * exposure;
#if defined(VIEW_ACES)
  return clamp(aces_view(vec4(clamp(c, -65504.0, 65504.0), 1.0)).rgb, 0.0, 1.0);
#else
  c = clamp(c, 0.0, 1e30);
#if defined(VIEW_AGX)
  return agx(c);
#else
#if defined(VIEW_GT)
  c = vec3(gt_curve(c.r), gt_curve(c.g), gt_curve(c.b));
#elif defined(VIEW_KHRONOS)
  c = khronos(c);
#endif
  return clamp(srgb_encode(c), 0.0, 1.0);
#endif
#endif
}

vec3 selected(vec3 c) {
  return channel == 1 ? c.rrr : channel == 2 ? c.ggg : channel == 3 ? c.bbb : channel == 4 ? vec3(luminance(c)) : c;
}
float scalar(vec3 c) { return channel == 0 || channel >= 5 ? luminance(c) : selected(c).r; }

bool on_stripe(ivec2 at, bool rising) { return ((rising ? at.x + at.y : at.x - at.y) & 7) < 4; }

// render/exposure/overlay.h: zones, and parts of the curve.
float hatch(ivec2 at, bool rising) { return ((rising ? at.x + at.y : at.x - at.y) & 7) < 2 ? 0.7 : 1.0; }

vec3 zone_color(float exposed, ivec2 at) {
  float zone = grey_zone + log2(clamp(exposed, 1e-30, 1e30) / grey);
  int i = int(clamp(floor(zone + 0.5), 0.0, 16.0));
  bool below = i < 5;
  bool hatched = below ? i % 2 == 1 : i > 5 && i % 2 == 0;
  return zone_colors[i] * (hatched ? hatch(at, !below) : 1.0);
}

vec3 map_color(float t, bool is_signed) {
  if (is_signed) {
    float at = 2.0 * (clamp(t, -1.0, 1.0) + 1.0);
    int low = min(int(at), 3);
    return mix(signed_colors[low], signed_colors[low + 1], at - float(low));
  }
  float at = 17.0 * clamp(t, 0.0, 1.0);
  int low = min(int(at), 16);
  return mix(magma[low], magma[low + 1], at - float(low));
}

// One picture: its light, the flaws of the pixel, and where on the grid of stripes it is.
vec3 picture(vec3 light, int flaws, ivec2 at, bool is_render) {
  float y = luminance(light), exposed = y * exposure;
#if OVERLAY == 1
  vec3 result = zone_color(exposed, at);
#elif OVERLAY == 2
  vec3 result = shown(vec3(y));
  if (exposed < limits.x) result = mix(result, toe_color, 0.6) * hatch(at, false);
  else if (exposed > limits.y) result = mix(result, shoulder_color, 0.6) * hatch(at, true);
#else
  vec3 result = shown(selected(light));
#endif
#if defined(ZEBRA)
  vec3 full = shown(light);
  if (max(full.r, max(full.g, full.b)) >= 254.5 / 255.0 && on_stripe(at, true)) result = display_stripe;
  if (!is_render && (flaws & (kClipped | kNotFinite)) != 0 && on_stripe(at, false)) result = sensor_stripe;
#endif
  if (channel == 6) return map_color(exposed, true);
  return channel == 5 ? vec3((flaws & kMasked) != 0 ? 0.1 : 1.0) : result;
}

// render/image/cie_lab.h
float lab_curve(float t) { return t > 216.0 / 24389.0 ? pow(t, 1.0 / 3.0) : t * (841.0 / 108.0) + 4.0 / 29.0; }
vec3 lab(vec3 display) {
  vec3 c = vec3(srgb_decode(display.r), srgb_decode(display.g), srgb_decode(display.b));
  const mat3 xyz_of = mat3(10135552.0 / 24577794.0, 2613072.0 / 12288897.0, 1425312.0 / 73733382.0,
                           8788810.0 / 24577794.0, 8788810.0 / 12288897.0, 8788810.0 / 73733382.0,
                           4435075.0 / 24577794.0, 887015.0 / 12288897.0, 70074185.0 / 73733382.0);
  vec3 t = xyz_of * c / (xyz_of * vec3(1.0));
  float x = lab_curve(t.x), y = lab_curve(t.y), z = lab_curve(t.z);
  return vec3(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z));
}

// olat/metric/formulas.h
const float kPi = 3.14159265358979, kRadian = kPi / 180.0;
float power7(float x) { return x * x * x * x * x * x * x; }
float chroma_share(float c) { return sqrt(power7(c) / (power7(c) + power7(25.0))); }
float hue(float a, float b) {
  if (a == 0.0 && b == 0.0) return 0.0;
  float h = atan(b, a);
  return h < 0.0 ? h + 2.0 * kPi : h;
}
float delta_e_2000(vec3 p, vec3 q) {
  float g = 0.5 * (1.0 - chroma_share(0.5 * (length(p.yz) + length(q.yz))));
  float ap = (1.0 + g) * p.y, aq = (1.0 + g) * q.y;
  float cp = length(vec2(ap, p.z)), cq = length(vec2(aq, q.z));
  float hp = hue(ap, p.z), hq = hue(aq, q.z);
  bool is_grey = cp * cq == 0.0;
  float dl = q.x - p.x, dc = cq - cp, dh = is_grey ? 0.0 : hq - hp;
  dh += dh > kPi ? -2.0 * kPi : dh < -kPi ? 2.0 * kPi : 0.0;
  float dhue = 2.0 * sqrt(cp * cq) * sin(0.5 * dh), l = 0.5 * (p.x + q.x), c = 0.5 * (cp + cq), h = hp + hq;
  if (!is_grey) h = 0.5 * (abs(hp - hq) <= kPi ? h : h < 2.0 * kPi ? h + 2.0 * kPi : h - 2.0 * kPi);
  float t = 1.0 - 0.17 * cos(h - 30.0 * kRadian) + 0.24 * cos(2.0 * h) + 0.32 * cos(3.0 * h + 6.0 * kRadian) -
            0.20 * cos(4.0 * h - 63.0 * kRadian);
  float bell = (h / kRadian - 275.0) / 25.0, turn = 60.0 * kRadian * exp(-bell * bell), l50 = (l - 50.0) * (l - 50.0);
  float sl = 1.0 + 0.015 * l50 / sqrt(20.0 + l50), sc = 1.0 + 0.045 * c, sh = 1.0 + 0.015 * c * t;
  float rt = -sin(turn) * 2.0 * chroma_share(c), x = dl / sl, y = dc / sc, z = dhue / sh;
  return sqrt(max(0.0, x * x + y * y + z * z + rt * y * z));
}

#if defined(METRIC)
vec3 difference(vec3 p, vec3 r, int flaws, float seen) {
  if (!has_photo || !has_render || (flaws & kMasked) != 0) return vec3(surround);
  float a = scalar(p), b = scalar(r), n = max(noise, kLeastNoise), value = 0.0;
#if METRIC == 0
  value = log2(max(a, 0.0) + n) - log2(max(b, 0.0) + n);
#elif METRIC == 1
  value = (a - b) * exposure;
#elif METRIC == 2
  value = abs(a - b) * exposure;
#elif METRIC == 3
  value = 2.0 * abs(a - b) / (abs(a) + abs(b) + 2.0 * n);
#elif METRIC == 4
  value = delta_e_2000(lab(shown(selected(p))), lab(shown(selected(r))));
#else
  if (!has_flip) return vec3(surround);
  value = seen;
#endif
  return map_color(value / range, METRIC < 2);
}
#endif

// A texel is taken as it is where it covers a canvas pixel or more, and between its neighbours where it does not.
vec3 light_at(sampler2D from, vec2 at) {
#if defined(MINIFIED)
  return texture(from, at / size).rgb;
#else
  return texelFetch(from, ivec2(at / size * vec2(textureSize(from, 0))), 0).rgb;
#endif
}
int flaws_at(vec2 at) {
#if defined(FLAWS)
  ivec2 whole = textureSize(photo, 0);
  return int(texelFetch(photo, clamp(ivec2(at / size * vec2(whole)), ivec2(0), whole - 1), 0).a + 0.5);
#else
  return 0;
#endif
}

void main() {
  vec2 at = vec2(gl_FragCoord.x, canvas.y - gl_FragCoord.y);
#if defined(WEDGE)
  if (at.y >= canvas.y - wedge) {
    float zone = floor(at.x * 17.0 / canvas.x);
    color = vec4(shown(vec3(grey * exp2(zone - grey_zone))), 1.0);
    return;
  }
#endif
  bool right = at.x >= pane_width;
  if (right) at.x -= pane_width;
  vec2 from = at - origin, q = from / zoom;
  ivec2 stripe = ivec2(floor(from));
  color = vec4(vec3(surround), 1.0);
  if (q.x < 0.0 || q.y < 0.0 || q.x >= size.x || q.y >= size.y) return;

  int flaws = flaws_at(q);
#if defined(METRIC)
  color.rgb = difference(light_at(photo, q), light_at(render, q) * gain, flaws, has_flip ? light_at(flip, q).r : 0.0);
#elif defined(ONION)
  vec3 a = has_photo ? picture(light_at(photo, q), flaws, stripe, false) : vec3(surround);
  vec3 b = has_render ? picture(light_at(render, q) * gain, flaws, stripe, true) : vec3(surround);
  color.rgb = mix(a, b, onion);
#elif defined(PANES)
  bool is_render = mode == kSide ? right : floor(q.x) + 0.5 >= split * size.x;
  if (is_render ? !has_render : !has_photo) return;
  vec3 p = light_at(photo, q), r = light_at(render, q) * gain;
  color.rgb = picture(is_render ? r : p, flaws, stripe, is_render);
#elif defined(RENDER)
  if (has_render) color.rgb = picture(light_at(render, q) * gain, flaws, stripe, true);
#else
  if (has_photo) color.rgb = picture(light_at(photo, q), flaws, stripe, false);
#endif
}
