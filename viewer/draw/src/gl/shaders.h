// SPDX-License-Identifier: BSD-3-Clause
// The shaders of the renderer. Positions are in the camera frame C (metres, x right, y up, z towards the
// viewer), so that floats are precise far from the world's origin. Colours are linear.
#pragma once

namespace vps::viewer::glsl {

// --- solid surfaces ---

inline constexpr const char* kMeshVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 vertex_color;
uniform mat4 X_CP, projection;
uniform vec4 cut_C;  // keeps n.p <= w
out vec3 p_C, n_C, tint;
void main() {
  tint = vertex_color;
  vec4 p = X_CP * vec4(position, 1);
  p_C = p.xyz;
  n_C = mat3(X_CP) * normal;
  gl_Position = projection * p;
  gl_ClipDistance[0] = cut_C.w - dot(cut_C.xyz, p.xyz);
}
)";

// Lights that are fixed to the camera, so that every view is well lit: a large key light top left, a fill
// light from the right, a rim light from behind, and a sky over a light floor. Highlights are reflections of
// the lights with Schlick's Fresnel term [Schlick 1994].
inline constexpr const char* kStudio = R"(
uniform vec3 up_C;
uniform sampler2D light_reaching;  // share of the light of the sky (x) and of the key light (y): see kOcclusionFragment
uniform vec2 picture_px;
const vec3 kKey = normalize(vec3(-0.55, 0.75, 0.60));
const vec3 kFill = normalize(vec3(0.85, 0.10, 0.50));
const vec3 kRim = normalize(vec3(0.35, 0.45, -0.85));

vec3 environment(vec3 r) {
  float height = dot(r, up_C);
  vec3 sky = mix(vec3(0.30, 0.29, 0.28), vec3(0.80, 0.84, 0.90), smoothstep(-0.35, 0.6, height));
  return sky + vec3(2.2) * smoothstep(0.80, 0.97, dot(r, kKey)) + vec3(0.8) * smoothstep(0.82, 0.97, dot(r, kFill));
}

vec3 studio(vec3 p_C, vec3 n, vec3 albedo) {
  vec3 v = normalize(-p_C);
  vec2 reaching = texture(light_reaching, gl_FragCoord.xy / picture_px).rg;
  float open = reaching.r, lit = reaching.g;
  float n_v = max(dot(n, v), 0.0);
  vec3 hemisphere = mix(vec3(0.21, 0.20, 0.195), vec3(0.42, 0.44, 0.47), 0.5 + 0.5 * dot(n, up_C));
  vec3 diffuse = hemisphere * open;
  diffuse += vec3(0.76, 0.74, 0.70) * max(dot(n, kKey), 0.0) * lit;
  diffuse += vec3(0.17, 0.18, 0.20) * max(0.3 + 0.7 * dot(n, kFill), 0.0) * mix(open, 1.0, 0.5);
  diffuse += vec3(0.22, 0.23, 0.25) * max(dot(n, kRim), 0.0) * open;
  float grazing = 1.0 - n_v, grazing2 = grazing * grazing;
  float fresnel = 0.04 + 0.40 * grazing2 * grazing2 * grazing;
  vec3 mirrored = environment(reflect(-v, n)) * mix(0.35, 1.0, lit) * open;
  return albedo * diffuse + fresnel * mirrored;
}
)";

inline constexpr const char* kMeshFragment = R"(
in vec3 p_C, n_C, tint;
uniform vec3 color;
uniform float tint_share;
out vec4 result;
void main() {
  vec3 n = normalize(gl_FrontFacing ? n_C : -n_C);
  result = vec4(studio(p_C, n, color * mix(vec3(1), tint, tint_share)), 1);
}
)";

// The target is transparent where it faces the viewer and denser towards its rim, so that its shape is
// visible.
inline constexpr const char* kGhostFragment = R"(
in vec3 p_C, n_C;
uniform vec3 color;
out vec4 result;
void main() {
  vec3 n = normalize(gl_FrontFacing ? n_C : -n_C);
  float grazing = 1.0 - max(dot(n, normalize(-p_C)), 0.0);
  float rim = grazing * grazing;
  float shade = 0.75 + 0.35 * n.y;
  result = vec4(color * shade, 0.27 + 0.40 * rim);
}
)";

// Cut faces are drawn as in a technical drawing: tinted and hatched at 45 degrees, in alternating directions.
inline constexpr const char* kCapVertex = R"(
layout(location = 0) in vec2 corner;
uniform vec3 origin_C, x_C, y_C;
uniform float half_size_m;
uniform mat4 projection;
out vec3 p_C, n_C;
out vec2 p_plane_m;
void main() {
  p_plane_m = half_size_m * corner;
  p_C = origin_C + x_C * p_plane_m.x + y_C * p_plane_m.y;
  n_C = cross(x_C, y_C);
  gl_Position = projection * vec4(p_C, 1);
}
)";

inline constexpr const char* kCapFragment = R"(
in vec3 p_C, n_C;
in vec2 p_plane_m;
uniform vec3 color;
uniform vec2 hatch;  // unit vector across the lines
uniform float hatch_step_m;
out vec4 result;
void main() {
  float t = dot(p_plane_m, hatch) / hatch_step_m;
  float width = fwidth(t);
  float distance_to_line = abs(fract(t) - 0.5);
  float line = 1.0 - smoothstep(0.09 - width, 0.09 + width, distance_to_line);
  line *= 1.0 - smoothstep(0.3, 0.6, width);  // the hatch fades out where its lines are too fine for the pixels
  vec3 paper = mix(color, vec3(0.85), 0.25);
  vec3 base = mix(paper, paper * 0.42, line);
  result = vec4(0.55 * base + 0.45 * studio(p_C, normalize(n_C), base), 1);
}
)";

// --- inputs of later passes ---

inline constexpr const char* kGeometryFragment = R"(
in vec3 p_C, n_C;
out vec4 result;  // normal, z
void main() { result = vec4(normalize(gl_FrontFacing ? n_C : -n_C), p_C.z); }
)";

inline constexpr const char* kEmptyFragment = "void main() {}\n";

inline constexpr const char* kFullScreenVertex = R"(
out vec2 uv;  // 0 to 1
void main() {
  uv = vec2(gl_VertexID == 1 ? 2 : 0, gl_VertexID == 2 ? 2 : 0);
  gl_Position = vec4(2.0 * uv - 1.0, 1, 1);  // at the far plane of the depth test
}
)";

// Computes ambient occlusion in screen space (the share of the hemisphere over a pixel that no nearer
// geometry covers) and the key light's soft shadow. The sample patterns are fixed and differ from pixel to
// pixel of a square of 4 x 4, which the blur afterwards averages exactly. After the blur each point of a
// surface has 160 directions and 64 depths.
inline constexpr const char* kOcclusionFragment = R"(
in vec2 uv;
uniform sampler2D geometry;
uniform vec2 half_view;  // tan of half the angles of view
uniform vec2 view_shift;  // offset of the picture's middle, as tangents
uniform float radius_m;
uniform sampler2DShadow shadow_map;
uniform mat4 shadow_from_C;
uniform float shadow_offset_m;
out vec2 reaching;
const int kSamples = 10;
const vec2 kGolden = vec2(-0.7373688, 0.6754903);  // cosine and sine of 137.5 degrees

// The pixels of a square have an 8 x 8 grid of depths between them, over 10 x 10 texels.
float keyLight(vec3 p_C, vec3 n, ivec2 tile) {
  vec4 s = shadow_from_C * vec4(p_C + shadow_offset_m * n, 1);
  vec2 texel = 1.0 / vec2(textureSize(shadow_map, 0));
  vec2 first = 1.25 * (vec2(tile) + 0.5) - 5.0;
  float lit = 0.0;
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) lit += texture(shadow_map, vec3(s.xy + (first + 5.0 * vec2(x, y)) * texel, s.z));
  return 0.25 * lit;
}

void main() {
  vec4 g = texture(geometry, uv);
  reaching = vec2(1);
  if (g.w > -1e-9 || g.w < -1e8) return;
  vec3 p = vec3(((2.0 * uv - 1.0) * half_view + view_shift) * -g.w, g.w);
  vec3 n = g.xyz;
  ivec2 tile = ivec2(gl_FragCoord.xy) & 3;
  float lit = keyLight(p, n, tile);
  p += n * radius_m * 0.03;
  float place = (float(((4 * tile.x + tile.y) * 7) & 15) + 0.5) / 16.0;
  // Each direction is the previous one turned by the golden angle; multiplying by a rotation is faster than sine and cosine.
  vec2 turn = vec2(cos(6.2831853 * place), sin(6.2831853 * place));
  vec3 t = normalize(abs(n.x) < 0.8 ? cross(n, vec3(1, 0, 0)) : cross(n, vec3(0, 1, 0)));
  vec3 b = cross(n, t);
  float hidden = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    float share = (float(i) + place) / float(kSamples);
    float sin_t = sqrt(share);  // cosine-weighted directions
    vec3 d = t * (turn.x * sin_t) + b * (turn.y * sin_t) + n * sqrt(1.0 - share);
    turn = vec2(turn.x * kGolden.x - turn.y * kGolden.y, turn.x * kGolden.y + turn.y * kGolden.x);
    float reach = fract(share * 7.31 + 0.13);
    vec3 s = p + d * radius_m * (0.08 + 0.92 * reach * reach);
    float z = texture(geometry, 0.5 + 0.5 * (s.xy / -s.z - view_shift) / half_view).w;
    // Geometry far in front is the silhouette of another body and is ignored.
    float nearby = smoothstep(0.0, 1.0, radius_m / max(abs(p.z - z), 1e-12));
    hidden += z > s.z + radius_m * 0.02 ? nearby : 0.0;
  }
  float open = clamp(1.0 - hidden / float(kSamples), 0.0, 1.0);
  reaching = vec2(open * sqrt(open), lit);
}
)";

inline constexpr const char* kOcclusionBlurFragment = R"(
uniform sampler2D occlusion, geometry;
uniform float radius_m;
out vec2 reaching;
void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(occlusion, 0) - 1;
  float z = texelFetch(geometry, here, 0).w;
  vec2 sum = vec2(0);
  float weights = 0.0;
  for (int y = -2; y < 2; ++y)
    for (int x = -2; x < 2; ++x) {
      ivec2 q = clamp(here + ivec2(x, y), ivec2(0), last);
      float weight = abs(texelFetch(geometry, q, 0).w - z) < 0.3 * radius_m ? 1.0 : 0.001;
      sum += weight * texelFetch(occlusion, q, 0).rg;
      weights += weight;
    }
  reaching = sum / weights;
}
)";

// Marks the nearest part above each place of the floor, seen from below: x decays quickly with the part's
// height, y slowly.
inline constexpr const char* kFloorFragment = R"(
in vec3 p_C, n_C;
uniform vec3 floor_C, up_C;
uniform float size_m;
out vec2 result;
void main() {
  float height = max(dot(p_C - floor_C, up_C), 0.0) / size_m;
  result = vec2(exp(-height / 0.02), exp(-height / 0.25));
}
)";

// The program puts the constants kReach and kWeights (for x and y, of texels -kReach to kReach) before this
// source. All texels that the shader reads exist.
inline constexpr const char* kFloorBlurFragment = R"(
uniform sampler2D source;
uniform ivec2 direction;
out vec2 result;
void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  vec2 sum = vec2(0);
  for (int i = -kReach; i <= kReach; ++i)
    sum += kWeights[i + kReach] * texelFetch(source, here + i * direction, 0).rg;
  result = sum;
}
)";

inline constexpr const char* kFloorShadowFragment = R"(
in vec3 p_C, n_C;
in vec2 p_plane_m;
uniform sampler2D floor_shadow;
uniform float half_size_m;
out vec4 result;
void main() {
  vec2 shadow = texture(floor_shadow, 0.5 + 0.5 * p_plane_m / half_size_m).rg;
  float edge = 1.0 - smoothstep(0.75, 1.0, length(p_plane_m) / half_size_m);
  result = vec4(0.02, 0.025, 0.035, edge * clamp(0.55 * shadow.x + 0.42 * shadow.y, 0.0, 0.8));
}
)";

inline constexpr const char* kBackgroundFragment = R"(
in vec2 uv;
out vec4 result;
uniform float darkness;
void main() {
  vec3 low = vec3(0.70, 0.715, 0.735), high = vec3(0.93, 0.94, 0.955);
  if (darkness > 0.5) {
    low = vec3(0.020, 0.023, 0.027);
    high = vec3(0.060, 0.066, 0.075);
  }
  vec3 c = mix(low, high, smoothstep(0.0, 0.85, uv.y));
  result = vec4(c, 1);
}
)";

// --- lines and marks ---

// Draws a line as a screen-aligned strip, because core profiles guarantee lines of one pixel only. The strip
// is moved slightly towards the eye, so that an edge lies in front of its own faces.
inline constexpr const char* kLineVertex = R"(
layout(location = 0) in vec3 a;
layout(location = 1) in vec3 b;
uniform mat4 X_CP, projection;
uniform vec4 cut_C;
uniform vec2 picture_px;
uniform float width_px, pull, near_m;
void main() {
  vec3 pa = (X_CP * vec4(a, 1)).xyz * (1.0 - pull), pb = (X_CP * vec4(b, 1)).xyz * (1.0 - pull);
  float za = -pa.z - near_m, zb = -pb.z - near_m;
  if (za < 0.0 && zb > 0.0) pa = mix(pa, pb, -za / (zb - za));
  if (zb < 0.0 && za > 0.0) pb = mix(pb, pa, -zb / (za - zb));
  vec4 ca = projection * vec4(pa, 1), cb = projection * vec4(pb, 1);
  vec2 along = (cb.xy / cb.w - ca.xy / ca.w) * picture_px;
  along = dot(along, along) > 1e-12 ? normalize(along) : vec2(1, 0);
  bool is_end = gl_VertexID >= 2;
  float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
  vec4 c = is_end ? cb : ca;
  vec2 shift = vec2(-along.y, along.x) * side + (is_end ? along : -along) * 0.5;
  c.xy += shift * width_px / picture_px * c.w;
  gl_Position = c;
  gl_ClipDistance[0] = cut_C.w - dot(cut_C.xyz, is_end ? pb : pa);
}
)";

inline constexpr const char* kFlatFragment = R"(
uniform vec4 color;
out vec4 result;
void main() { result = color; }
)";

// Draws one unit arrow or disc along +z per instance.
inline constexpr const char* kMarkVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 base_C;
layout(location = 3) in vec3 axis_C;   // unit
layout(location = 4) in vec2 size_m;   // length along the axis, width across
layout(location = 5) in vec3 mark_color;
uniform mat4 projection;
uniform float pull;
out vec3 n_C, tint;
void main() {
  vec3 t = normalize(abs(axis_C.x) < 0.8 ? cross(axis_C, vec3(1, 0, 0)) : cross(axis_C, vec3(0, 1, 0)));
  vec3 b = cross(axis_C, t);
  vec3 p = base_C + (t * position.x + b * position.y) * size_m.y + axis_C * position.z * size_m.x;
  n_C = t * normal.x + b * normal.y + axis_C * normal.z;
  tint = mark_color;
  gl_Position = projection * vec4(p * (1.0 - pull), 1);
}
)";

inline constexpr const char* kMarkFragment = R"(
in vec3 n_C, tint;
uniform float alpha;
out vec4 result;
void main() {
  vec3 n = normalize(n_C);
  float light = 0.72 + 0.38 * max(dot(n, normalize(vec3(-0.5, 0.75, 0.6))), 0.0);
  result = vec4(tint * light, alpha);
}
)";

// --- the finished picture ---

// Averages samples in linear colour, blends them over the background, compresses highlights instead of
// clipping them, and encodes as sRGB [IEC 61966-2-1]. The program puts the constants `factor`, `samples` and
// `has_parts` before this source, since llvmpipe runs loops of unknown length much slower. Without
// `has_parts`, only the background is drawn.
inline constexpr const char* kFinalFragment = R"(
uniform sampler2DMS parts;  // rgb: colour times opacity; a: opacity
uniform sampler2D behind;
out vec4 result;
vec3 shoulder(vec3 c) {  // identity up to 0.8, then asymptotically towards 1
  vec3 over = max(c - 0.8, 0.0);
  return min(c, 0.8) + over / (1.0 + over / 0.2);
}
void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * factor;
  vec3 background = texelFetch(behind, ivec2(gl_FragCoord.xy), 0).rgb;
  vec3 sum = vec3(0);
  for (int y = 0; y < factor; ++y)
    for (int x = 0; x < factor; ++x) {
      vec4 part = vec4(0);
      for (int i = 0; has_parts && i < samples; ++i) part += texelFetch(parts, first + ivec2(x, y), i);
      part /= float(samples);
      sum += shoulder(part.rgb + (1.0 - part.a) * background);
    }
  vec3 c = clamp(sum / float(factor * factor), 0.0, 1.0);
  result = vec4(mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c)), 1);
}
)";

}  // namespace vps::viewer::glsl
