// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// GLSL. Frames: view = metres along the building's walls, z up; clip = what WebGL draws.

const kCutGlsl = `
uniform vec3 cutAxis;      // zero: nothing is cut
uniform vec2 cutRange;     // metres along it
bool cutAway(vec3 x) {
  float along = dot(cutAxis, x);
  return dot(cutAxis, cutAxis) > 0.5 && (along < cutRange.x || along > cutRange.y);
}`;

// Five colours of the viridis map, distinct for every kind of sight and in grey.
const kRamp = [[0.267, 0.005, 0.329], [0.229, 0.322, 0.546], [0.128, 0.567, 0.551], [0.369, 0.789, 0.383], [0.993, 0.906, 0.144]];
const kRampGlsl = `
vec3 ramp(float t) {
  vec3 colours[5] = vec3[5](${kRamp.map((c) => `vec3(${c.map((x) => x.toFixed(3)).join(',')})`).join(',')});
  float at = clamp(t, 0.0, 1.0) * 4.0;
  int k = min(int(at), 3);
  return mix(colours[k], colours[k + 1], at - float(k));
}`;

const kPointVertex = `#version 300 es
precision highp float;
layout(location = 0) in vec3 number;
layout(location = 1) in vec4 own;
layout(location = 2) in uvec2 mark;
uniform mat4 viewFromNumbers;
uniform mat4 clipFromView;
uniform mat3 viewFromSide;
uniform vec3 eye;          // view frame; of parallel views the way towards the eye
uniform bool parallel;
uniform bool seeThrough;
uniform highp sampler2D normals;
uniform int colouring;     // 0 by side, 1 own, 2 residual, 3 height
uniform vec2 heights;      // metres, of the two ends of the ramp
uniform vec3 tint;
uniform vec3 plain;
uniform float size;
out vec3 colour;
${kCutGlsl}
${kRampGlsl}
void main() {
  vec3 x = (viewFromNumbers * vec4(number, 1.0)).xyz;
  gl_Position = clipFromView * vec4(x, 1.0);
  gl_PointSize = size;
  vec4 normal = texelFetch(normals, ivec2(int(mark.x), 0), 0);
  vec3 towards = parallel ? eye : normalize(eye - x);
  bool behind = seeThrough && mark.x > 0u && normal.w > 0.5 && dot(viewFromSide * normal.xyz, towards) < -0.03;
  if (behind || cutAway(x)) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); gl_PointSize = 0.0; }
  float grey = dot(own.rgb, vec3(0.3, 0.59, 0.11));
  // Planes are lit by where they face, so that corners show.
  float light = mark.x > 0u ? 0.68 + 0.36 * abs(dot(viewFromSide * normal.xyz, vec3(0.36, -0.6, 0.71))) : 0.9;
  colour = tint * (0.8 + 0.3 * grey) * light;
  if (colouring == 1) colour = own.rgb;
  if (colouring == 3) colour = ramp((x.z - heights.x) / max(heights.y - heights.x, 0.001)) * light;
  if (colouring == 2) colour = mark.y > 0u ? ramp(abs(float(mark.y) - 128.0) / 127.0) : plain * light;
}`;

const kPointFragment = `#version 300 es
precision highp float;
in vec3 colour;
out vec4 pixel;
void main() {
  vec2 off = gl_PointCoord - 0.5;
  if (dot(off, off) > 0.27) discard;
  pixel = vec4(colour, 1.0);
}`;

const kFaceVertex = `#version 300 es
precision highp float;
layout(location = 0) in vec3 number;
uniform mat4 viewFromNumbers;
uniform mat4 clipFromView;
out vec3 place;
void main() {
  place = (viewFromNumbers * vec4(number, 1.0)).xyz;
  gl_Position = clipFromView * vec4(place, 1.0);
}`;

const kFaceFragment = `#version 300 es
precision highp float;
in vec3 place;
uniform vec3 tint;
uniform float alpha;
out vec4 pixel;
${kCutGlsl}
void main() {
  if (cutAway(place)) discard;
  vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
  float light = 0.62 + 0.38 * abs(dot(normal, normalize(vec3(0.35, -0.5, 0.79))));
  pixel = vec4(tint * light * alpha, alpha);
}`;

// Every line is a strip as wide as asked for, drawn between two ends that each instance brings.
const kLineVertex = `#version 300 es
precision highp float;
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
uniform mat4 viewFromSide;
uniform mat4 clipFromView;
uniform vec2 screen;       // pixels
uniform float width;       // pixels
out vec3 place;
out float along;           // pixels
void main() {
  vec3 a = (viewFromSide * vec4(from, 1.0)).xyz;
  vec3 b = (viewFromSide * vec4(to, 1.0)).xyz;
  vec4 clipA = clipFromView * vec4(a, 1.0);
  vec4 clipB = clipFromView * vec4(b, 1.0);
  // An end behind the eye is moved to just before it.
  float near = 1e-3;
  if (clipA.w < near && clipB.w >= near) { float t = (near - clipA.w) / (clipB.w - clipA.w); clipA = mix(clipA, clipB, t); a = mix(a, b, t); }
  if (clipB.w < near && clipA.w >= near) { float t = (near - clipB.w) / (clipA.w - clipB.w); clipB = mix(clipB, clipA, t); b = mix(b, a, t); }
  vec2 pixelA = clipA.xy / clipA.w * screen * 0.5;
  vec2 pixelB = clipB.xy / clipB.w * screen * 0.5;
  vec2 way = pixelB - pixelA;
  float length_ = max(length(way), 1e-3);
  vec2 aside = vec2(-way.y, way.x) / length_;
  bool end = (gl_VertexID & 1) == 1;
  float side = gl_VertexID < 2 ? -0.5 : 0.5;
  vec4 clip = end ? clipB : clipA;
  clip.xy += aside * side * width * 2.0 / screen * clip.w;
  if (clipA.w < near && clipB.w < near) clip = vec4(2.0, 2.0, 2.0, 1.0);
  place = end ? b : a;
  along = end ? length_ : 0.0;
  gl_Position = clip;
}`;

const kLineFragment = `#version 300 es
precision highp float;
in vec3 place;
in float along;
uniform vec4 colour;       // not multiplied with its alpha
uniform float dash;        // pixels of one dash with its gap; 0: a whole line
out vec4 pixel;
${kCutGlsl}
void main() {
  if (cutAway(place)) discard;
  if (dash > 0.0 && fract(along / dash) > 0.6) discard;
  pixel = vec4(colour.rgb * colour.a, colour.a);
}`;

// Brings out edges by shading what lies behind its neighbours on the screen.
const kShadeVertex = `#version 300 es
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
  gl_Position = vec4(corner, 0.0, 1.0);
}`;

const kShadeFragment = `#version 300 es
precision highp float;
uniform sampler2D colours;
uniform highp sampler2D depths;
uniform vec2 range;        // near and far, metres
uniform bool parallel;
uniform float reach;       // pixels
uniform float height;      // metres that the view shows
uniform vec3 shadow;
out vec4 pixel;
float metresAt(ivec2 at) {
  float d = texelFetch(depths, at, 0).r;
  if (parallel) return mix(range.x, range.y, d);
  return range.x * range.y / (range.y - d * (range.y - range.x));
}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(depths, 0) - 1;
  float own = texelFetch(depths, at, 0).r;
  if (own >= 1.0) { pixel = vec4(0.0); return; }
  float here = metresAt(at);
  float sum = 0.0;
  for (int k = 0; k < 8; ++k) {
    float angle = float(k) * 0.7853982;
    ivec2 other = clamp(at + ivec2(round(reach * vec2(cos(angle), sin(angle)))), ivec2(0), last);
    if (texelFetch(depths, other, 0).r >= 1.0) continue;
    float there = metresAt(other);
    sum += clamp(parallel ? (here - there) / height * 0.6 : log2(here) - log2(there), 0.0, 0.03);
  }
  float shade = exp(-sum * 9.0);
  pixel = vec4(mix(shadow, texelFetch(colours, at, 0).rgb, 0.4 + 0.6 * shade), 1.0);
}`;
