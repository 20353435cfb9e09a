// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// A thin layer over WebGL2: programs, buffers, the picture that is shaded by depth.

const compiled = (gl, type, text) => {
  const shader = gl.createShader(type);
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  return shader;
};

/** A program with its uniforms by name; `set` takes numbers, vectors and matrices. */
const makeProgram = (gl, vertex, fragment) => {
  const program = gl.createProgram();
  gl.attachShader(program, compiled(gl, gl.VERTEX_SHADER, vertex));
  gl.attachShader(program, compiled(gl, gl.FRAGMENT_SHADER, fragment));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  const uniforms = new Map();
  for (let k = 0; k < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); ++k) {
    const { name, type } = gl.getActiveUniform(program, k);
    uniforms.set(name, { place: gl.getUniformLocation(program, name), type });
  }
  const setters = new Map([
    [gl.FLOAT, (p, v) => gl.uniform1f(p, v)], [gl.FLOAT_VEC2, (p, v) => gl.uniform2fv(p, v)],
    [gl.FLOAT_VEC3, (p, v) => gl.uniform3fv(p, v)], [gl.FLOAT_VEC4, (p, v) => gl.uniform4fv(p, v)],
    [gl.FLOAT_MAT3, (p, v) => gl.uniformMatrix3fv(p, false, v)], [gl.FLOAT_MAT4, (p, v) => gl.uniformMatrix4fv(p, false, v)]]);
  const set = (values) => {
    for (const [name, value] of Object.entries(values)) {
      const uniform = uniforms.get(name);
      if (!uniform) continue;
      (setters.get(uniform.type) ?? ((p, v) => gl.uniform1i(p, +v)))(uniform.place, value);
    }
  };
  return { use: () => gl.useProgram(program), set };
};

const makeBuffer = (gl, values, usage = gl.STATIC_DRAW) => {
  const buffer = gl.createBuffer();
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.bufferData(gl.ARRAY_BUFFER, values, usage);
  return buffer;
};

/** Points or triangles of one side on the graphics card. */
const makeCloud = (gl, side) => {
  if (side.shape === 'none') return null;
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  makeBuffer(gl, side.numbers);
  gl.enableVertexAttribArray(0);
  gl.vertexAttribPointer(0, 3, gl.UNSIGNED_SHORT, true, 6, 0);
  if (side.shape === 'points') {
    makeBuffer(gl, side.colours);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribPointer(1, 4, gl.UNSIGNED_BYTE, true, 4, 0);
    makeBuffer(gl, side.marks);
    gl.enableVertexAttribArray(2);
    gl.vertexAttribIPointer(2, 2, gl.UNSIGNED_BYTE, 2, 0);
  }
  gl.bindVertexArray(null);
  return { array, count: side.count, shape: side.shape, normals: normalsTexture(gl, side) };
};

/** Normals of the first 255 planes by their byte; w tells whether they point to where they were seen from. */
const normalsTexture = (gl, side) => {
  const values = new Float32Array(4 * 256);
  side.planes.slice(0, 255).forEach((plane, k) => values.set([...plane.n, plane.facing ? 1 : 0], 4 * (k + 1)));
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, 256, 1, 0, gl.RGBA, gl.FLOAT, values);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  return texture;
};

/** Line pieces, six numbers each; `replace` gives it others. */
const makeLines = (gl) => {
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  const buffer = makeBuffer(gl, new Float32Array(6), gl.DYNAMIC_DRAW);
  for (const k of [0, 1]) {
    gl.enableVertexAttribArray(k);
    gl.vertexAttribPointer(k, 3, gl.FLOAT, false, 24, 12 * k);
    gl.vertexAttribDivisor(k, 1);
  }
  gl.bindVertexArray(null);
  const lines = { array, count: 0 };
  lines.replace = (values) => {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(values), gl.DYNAMIC_DRAW);
    lines.count = values.length / 6;
    return lines;
  };
  return lines;
};

/** Colours and depths of one frame, which the shading reads. */
const makePicture = (gl) => {
  const frame = gl.createFramebuffer();
  const colours = gl.createTexture();
  const depths = gl.createTexture();
  let size = [0, 0];
  const layout = (texture, format, layoutOf, type) => {
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, format, size[0], size[1], 0, layoutOf, type, null);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
    for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, wrap, gl.CLAMP_TO_EDGE);
  };
  const begin = (width, height) => {
    if (size[0] !== width || size[1] !== height) {
      size = [width, height];
      layout(colours, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE);
      layout(depths, gl.DEPTH_COMPONENT24, gl.DEPTH_COMPONENT, gl.UNSIGNED_INT);
      gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, colours, 0);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, depths, 0);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  };
  return { begin, colours, depths };
};

const makePrograms = (gl) => ({
  points: makeProgram(gl, kPointVertex, kPointFragment), faces: makeProgram(gl, kFaceVertex, kFaceFragment),
  lines: makeProgram(gl, kLineVertex, kLineFragment), shade: makeProgram(gl, kShadeVertex, kShadeFragment),
});

/**
 * Draws a frame's surfaces onto an empty canvas: what `drawGlass` draws, and over it what `drawSolid` draws, shaded by
 * its depths. A model is glass: points in it are seen through its walls.
 */
const makeSurfacePainter = (gl, programs) => {
  const picture = makePicture(gl);
  const empty = gl.createVertexArray();
  const shade = (frame) => {
    programs.shade.use();
    [picture.colours, picture.depths].forEach((texture, k) => { gl.activeTexture(gl.TEXTURE0 + k); gl.bindTexture(gl.TEXTURE_2D, texture); });
    programs.shade.set({ colours: 0, depths: 1, range: frame.look.range, parallel: frame.look.parallel, reach: 1.5 * frame.ratio, height: frame.height, shadow: frame.shadow });
    gl.bindVertexArray(empty);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  };
  return (frame, drawSolid, drawGlass) => {
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    picture.begin(...frame.size);
    drawSolid();
    gl.disable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, ...frame.size);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    drawGlass();
    shade(frame);
  };
};

/** "#1f6fb4" of a style's variable as three shares; grey where it is written otherwise. */
const styleColour = (name) => {
  const text = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const digits = /^#([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})/i.exec(text);
  return digits ? digits.slice(1, 4).map((pair) => parseInt(pair, 16) / 255) : [0.5, 0.5, 0.5];
};
