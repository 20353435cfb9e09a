// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// Two scans from above, in which somebody shows the same places, or drags one over the other.

const kReachPx = 14;  // a click takes the nearest point within it
const kSectionM = 0.5;
const kBesideM = 5;  // the floor is that beside the scanner

/** x, y, z of a PLY file as limen writes it: binary, little-endian, the points first. */
const parsePly = (buffer) => {
  const head = new TextDecoder('latin1').decode(new Uint8Array(buffer, 0, Math.min(buffer.byteLength, 20000)));
  const end = head.indexOf('end_header\n') + 'end_header\n'.length;
  const sizes = { char: 1, uchar: 1, short: 2, ushort: 2, int: 4, uint: 4, float: 4, double: 8, int8: 1, uint8: 1, int16: 2, uint16: 2, int32: 4, uint32: 4, float32: 4, float64: 8 };
  const of = {};
  let stride = 0;
  for (const [, type, name] of head.slice(0, end).matchAll(/^property (\w+) (\w+)$/gm)) {
    of[name] = { at: stride, wide: sizes[type] === 8 };
    stride += sizes[type];
  }
  const count = +/element vertex (\d+)/.exec(head)[1];
  const data = new DataView(buffer, end);
  const axis = ({ at, wide }) => Float64Array.from({ length: count }, (_, k) => (wide ? data.getFloat64(k * stride + at, true) : data.getFloat32(k * stride + at, true)));
  const points = { count, x: axis(of.x), y: axis(of.y), z: axis(of.z) };
  const stated = /^comment scanner_position (\S+) (\S+)/m.exec(head.slice(0, end))?.slice(1).map(Number);
  return { ...points, floor: floorOf(points, stated ?? [points.x, points.y].map((values) => values.slice().sort()[count >> 1])) };
};

/** What all but a few hundredths of the values lie between. */
const spanOf = (values) => {
  const sorted = values.slice().sort();
  return [sorted[Math.floor(0.02 * (sorted.length - 1))], sorted[Math.ceil(0.98 * (sorted.length - 1))]];
};

/** The lowest level that holds a large surface beside a place. */
const floorOf = ({ x, y, z }, at) => {
  const levels = new Map();  // each: the squares of 0.2 m with a point in it
  z.forEach((value, k) => {
    if (Math.hypot(x[k] - at[0], y[k] - at[1]) > kBesideM) return;
    const level = Math.floor(value / 0.1);
    if (!levels.has(level)) levels.set(level, new Set());
    levels.get(level).add(`${Math.floor(x[k] / 0.2)} ${Math.floor(y[k] / 0.2)}`);
  });
  const most = Math.max(...[...levels.values()].map(({ size }) => size));
  const large = [...levels.keys()].filter((level) => levels.get(level).size >= 0.3 * most);
  return large.length ? 0.1 * (Math.min(...large) + 0.5) : spanOf(z)[0];
};

/** The plan of a file: limen thins it once, as work like any other. */
const plans = new Map();
const planOf = async (scan) => {
  const { bytes } = state.files.find(({ name }) => name === scan) ?? {};
  const key = `${scan} ${bytes}`;
  if (plans.has(key)) return plans.get(key);
  const made = () => state.jobs.findLast(({ kind, asked, state: how }) => kind === 'plan' && asked.scan === scan && asked.bytes === bytes && how !== 'stopped');
  if (!made() || made().state === 'failed') await post('jobs', { kind: 'plan', scan, bytes });
  do {
    await new Promise((resolve) => { setTimeout(resolve, 100); });
    await refresh();
  } while (['queued', 'running'].includes(made()?.state));
  if (made()?.state !== 'done') throw new Error(made()?.said || `${scan} cannot be read`);
  const points = parsePly(await (await fetch(`results/${made().id}/plan.ply`)).arrayBuffer());
  plans.set(key, points);
  return points;
};

/** One plan on its canvas: what it shows, where it looks, and its cross, by which keys point. */
class Plan {
  constructor(id, layers) {
    this.canvas = byId(id);
    this.layers = layers;  // () => [{ points, colour, pose }]
    this.view = { x: 0, y: 0, scale: 1 };
    this.cross = null;
    this.onPick = () => {};
    this.onDrag = null;
    this.marks = () => [];
    this.canvas.onpointerdown = (event) => this.press(event);
    this.canvas.onwheel = (event) => { event.preventDefault(); this.zoom(Math.exp(-0.0015 * event.deltaY), this.placeOf(event)); };
    this.canvas.onkeydown = (event) => this.key(event);
    this.canvas.onblur = () => { this.cross = null; this.draw(); };
  }

  get ratio() { return window.devicePixelRatio || 1; }
  placeOf(event) {
    const box = this.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }
  toPlan([px, py]) {
    return [this.view.x + (px - this.canvas.clientWidth / 2) / this.view.scale, this.view.y - (py - this.canvas.clientHeight / 2) / this.view.scale];
  }
  toCanvas([x, y]) {
    return [(x - this.view.x) * this.view.scale + this.canvas.clientWidth / 2, this.canvas.clientHeight / 2 - (y - this.view.y) * this.view.scale];
  }

  showAll() {
    const boxes = this.layers().map(({ points, pose }) => [points, pose]);
    if (boxes.length === 0) return;
    const [xs, ys] = [[], []];
    for (const [points, pose] of boxes) {
      const [[x0, x1], [y0, y1]] = [spanOf(points.x), spanOf(points.y)];
      for (const corner of [[x0, y0], [x1, y0], [x0, y1], [x1, y1]]) {
        const [x, y] = moved(pose, corner);
        xs.push(x);
        ys.push(y);
      }
    }
    const [x0, x1, y0, y1] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    this.view = { x: (x0 + x1) / 2, y: (y0 + y1) / 2, scale: 0.92 * Math.min(this.canvas.clientWidth / Math.max(1, x1 - x0), this.canvas.clientHeight / Math.max(1, y1 - y0)) };
    this.draw();
  }

  zoom(by, at) {
    const [x, y] = this.toPlan(at);
    this.view.scale = Math.min(2000, Math.max(0.2, this.view.scale * by));
    const [x2, y2] = this.toPlan(at);
    this.view.x += x - x2;
    this.view.y += y - y2;
    this.draw();
  }

  press(event) {
    this.canvas.focus();
    this.canvas.setPointerCapture(event.pointerId);
    const begun = this.placeOf(event);
    let last = begun;
    let far = false;
    this.canvas.onpointermove = (move) => {
      const now = this.placeOf(move);
      far = far || Math.hypot(now[0] - begun[0], now[1] - begun[1]) > 4;
      if (!far) return;
      if (this.onDrag) {
        this.onDrag(this.toPlan(last), this.toPlan(now), move.shiftKey || move.altKey);
      } else {
        this.view.x -= (now[0] - last[0]) / this.view.scale;
        this.view.y += (now[1] - last[1]) / this.view.scale;
        this.draw();
      }
      last = now;
    };
    const end = () => { this.canvas.onpointermove = this.canvas.onpointerup = this.canvas.onpointercancel = null; };
    this.canvas.onpointercancel = end;
    this.canvas.onpointerup = () => {
      end();
      if (!far) this.onPick(begun);
    };
  }

  key(event) {
    const middle = [this.canvas.clientWidth / 2, this.canvas.clientHeight / 2];
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const step = event.shiftKey ? 1 : 10;
    if (way && this.onDrag) {
      this.onDrag([0, 0], [way[0] * step / this.view.scale, -way[1] * step / this.view.scale], false);
    } else if (way) {
      this.cross = (this.cross ?? middle).map((at, k) => Math.min(2 * middle[k], Math.max(0, at + way[k] * step)));
      this.draw();
    } else if (event.key === 'Enter' || event.key === ' ') {
      this.onPick(this.cross ?? middle);
    } else if (event.key === '+' || event.key === '-') {
      this.zoom(event.key === '+' ? 1.25 : 0.8, this.cross ?? middle);
    } else if (event.key === '0') {
      this.showAll();
    } else if (this.onDrag && (event.key === ',' || event.key === '.')) {
      linking.turn((event.key === ',' ? 1 : -1) * (event.shiftKey ? 0.2 : 2) * Math.PI / 180);
    } else {
      return;
    }
    event.preventDefault();
  }

  /** Whether the section shows a point at a height over the floor: asked of the page once, then of many points. */
  static section() {
    const [all, middle] = [byId('link-all').checked, +byId('link-height').value];
    return (height) => all || Math.abs(height - middle) < kSectionM / 2;
  }

  /** The point that is shown nearest to a place on the canvas; null where none is near. */
  nearest(at) {
    const cut = Plan.section();
    const [x, y] = this.toPlan(at);
    let best = null;
    let least = (kReachPx / this.view.scale) ** 2;
    for (const { points } of this.layers()) {
      for (let k = 0; k < points.count; ++k) {
        if (!cut(points.z[k] - points.floor)) continue;
        const far = (points.x[k] - x) ** 2 + (points.y[k] - y) ** 2;
        if (far < least) [least, best] = [far, [points.x[k], points.y[k], points.z[k]]];
      }
    }
    return best;
  }

  draw() {
    const { canvas, ratio } = this;
    const [width, height] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
    if (width === 0 || height === 0) return;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    const context = canvas.getContext('2d');
    const image = context.createImageData(width, height);
    const dots = new Uint32Array(image.data.buffer);
    const cut = Plan.section();
    for (const shown of [false, true]) {
      const size = Math.round(ratio * (shown ? 2 : 1));
      for (const { points, colour, pose } of this.layers()) {
        const [r, g, b] = colour;
        const dot = (shown ? 0xff000000 : 0x38000000) | (b << 16) | (g << 8) | r;
        const { cosine, sine, x, y } = pose;
        for (let k = 0; k < points.count; ++k) {
          if (cut(points.z[k] - points.floor) !== shown) continue;
          const px = Math.round(((cosine * points.x[k] - sine * points.y[k] + x - this.view.x) * this.view.scale) * ratio + width / 2);
          const py = Math.round(height / 2 - ((sine * points.x[k] + cosine * points.y[k] + y - this.view.y) * this.view.scale) * ratio);
          if (px < 0 || py < 0 || px + size > width || py + size > height) continue;
          for (let row = 0; row < size; ++row) dots.fill(dot, (py + row) * width + px, (py + row) * width + px + size);
        }
      }
    }
    context.putImageData(image, 0, 0);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const style = getComputedStyle(canvas);
    this.marks().forEach((mark, k) => {
      const [px, py] = this.toCanvas(mark);
      context.beginPath();
      context.arc(px, py, 10, 0, 7);
      context.fillStyle = style.color;
      context.fill();
      context.fillStyle = style.backgroundColor;
      context.font = '600 13px system-ui, sans-serif';
      context.textAlign = 'center';
      context.textBaseline = 'middle';
      context.fillText(k + 1, px, py + 1);
    });
    if (this.cross) {
      context.strokeStyle = style.color;
      context.beginPath();
      context.moveTo(this.cross[0] - 12, this.cross[1]);
      context.lineTo(this.cross[0] + 12, this.cross[1]);
      context.moveTo(this.cross[0], this.cross[1] - 12);
      context.lineTo(this.cross[0], this.cross[1] + 12);
      context.stroke();
    }
    canvas.dataset.view = JSON.stringify(this.view);
  }
}

// A pose from above: a turn about the vertical, and a shift.
const kStill = { cosine: 1, sine: 0, x: 0, y: 0 };
const moved = ({ cosine, sine, x, y }, [px, py]) => [cosine * px - sine * py + x, sine * px + cosine * py + y];
const turnedAbout = (pose, angle, [x, y]) => {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const [dx, dy] = [pose.x - x, pose.y - y];
  return { ...pose, cosine: c * pose.cosine - s * pose.sine, sine: s * pose.cosine + c * pose.sine, x: x + c * dx - s * dy, y: y + s * dx + c * dy };
};
const meanOf = (places) => places.reduce((sum, place) => sum.map((value, k) => value + place[k] / places.length), [0, 0, 0]);

/** Of pairs of places: least squares, for the picture; limen makes its own. */
const poseOf = (from, to) => {
  const [a, b] = [meanOf(from), meanOf(to)];
  let [cosine, sine] = [0, 0];
  from.forEach((place, k) => {
    const [x, y, u, v] = [place[0] - a[0], place[1] - a[1], to[k][0] - b[0], to[k][1] - b[1]];
    cosine += x * u + y * v;
    sine += x * v - y * u;
  });
  const turned = Math.atan2(sine, cosine);
  const pose = { cosine: Math.cos(turned), sine: Math.sin(turned), x: 0, y: 0 };
  const [x, y] = moved(pose, a);
  return { ...pose, x: b[0] - x, y: b[1] - y };
};

const kAsk = 'Click the same place in both scans.';
const kOrange = [201, 102, 10];
const kBlue = [31, 111, 180];
const linking = {
  project: null,           // the job whose scans they are; null: files
  sides: [null, null],     // the points of the two
  places: [[], []],        // what was clicked in them
  pose: kStill,
  dragged: false,

  say(text, fault = false) {
    byId('link-said').textContent = text;
    byId('link-said').className = fault ? 'fault' : '';
  },

  centre() {
    const [[x0, x1], [y0, y1]] = [spanOf(this.sides[0].x), spanOf(this.sides[0].y)];
    return [(x0 + x1) / 2, (y0 + y1) / 2];
  },
  ready() { return this.sides[0] && this.sides[1]; },
  pairs() { return Math.min(...this.places.map((list) => list.length)); },

  drag(from, to, turns) {
    if (!this.ready()) return;
    if (turns) {
      const [x, y] = moved(this.pose, this.centre());
      this.turn(Math.atan2(to[1] - y, to[0] - x) - Math.atan2(from[1] - y, from[0] - x));
      return;
    }
    this.dragged = true;
    this.pose = { ...this.pose, x: this.pose.x + to[0] - from[0], y: this.pose.y + to[1] - from[1] };
    this.show();
  },
  turn(angle) {
    if (!this.ready()) return;
    this.dragged = true;
    this.pose = turnedAbout(this.pose, angle, moved(this.pose, this.centre()));
    this.show();
  },

  pick(side, at) {
    const place = this.sides[side] && planViews[side].nearest(at);
    if (!place) {
      this.say('No point is near enough: click on a wall of the section.', true);
      return;
    }
    this.places[side].push(place);
    this.dragged = false;
    this.fit();
    const missing = [0, 1].map((k) => 3 - this.places[k].length);
    this.say(missing[0] <= 0 && missing[1] <= 0 ? 'Press Register from this start.' : `Place ${this.places[side].length} is set. ${missing[1 - side] > missing[side] ? `Now the same place in the ${side ? 'moving' : 'fixed'} scan.` : 'Now the next place.'}`);
  },
  undo() {
    const [a, b] = this.places;
    (a.length > b.length ? a : b).pop();
    this.fit();
  },
  clear() {
    this.places = [[], []];
    this.dragged = false;
    if (this.ready()) this.lay();
    this.fit();
    this.say(kAsk);
  },

  /** One over the other, as they are. */
  lay() {
    const middles = this.sides.map(({ x, y, floor }) => [...[x, y].map((axis) => spanOf(axis).reduce((a, b) => (a + b) / 2)), floor]);
    this.pose = poseOf([middles[0]], [middles[1]]);
  },
  fit() {
    const count = this.pairs();
    if (count >= 2) this.pose = poseOf(...this.places.map((list) => list.slice(0, count)));
    this.show();
    if (count >= 2) planViews[2].showAll();
  },

  show() {
    const count = this.pairs();
    const rows = this.places[0].length > 0 || this.places[1].length > 0;
    byId('link-count').textContent = this.dragged ? 'The dragged pose is the start.' : `${count} of 3 pairs of places`;
    byId('link-go').disabled = !this.ready() || (count < 3 && !this.dragged);
    byId('link-undo').disabled = byId('link-clear').disabled = !rows && !this.dragged;
    for (const plan of planViews) plan.draw();
  },

  /** Six numbers each: what was clicked, or places that the dragged pose brings together. */
  points() {
    if (!this.dragged) return this.places[0].slice(0, this.pairs()).map((place, k) => [...place, ...this.places[1][k]]);
    const [x, y] = this.centre();
    return [[5, 0], [-5, 5], [-5, -5]].map(([dx, dy]) => {
      const place = [x + dx, y + dy];
      return [...place, this.sides[0].floor, ...moved(this.pose, place), this.sides[1].floor];
    });
  },

  async load() {
    this.sides = [null, null];
    this.clear();
    const names = ['source', 'target'].map((side) => byId(`link-${side}`).value);
    if (names[0] === names[1]) {
      this.say('Choose two different scans.', true);
      return;
    }
    this.say('The plans are made\u2026');
    try {
      for (const [side, name] of names.entries()) {
        const points = await planOf(name);
        if (names.some((other, k) => other !== byId(['link-source', 'link-target'][k]).value)) return;
        this.sides[side] = points;
        planViews[side].showAll();
      }
      this.lay();
      planViews[2].showAll();
      this.show();
      this.say(kAsk);
    } catch (error) { this.say(error.message, true); }
  },

  async go() {
    const [source, target] = ['source', 'target'].map((side) => byId(`link-${side}`).value);
    try {
      const { id } = await post('jobs', { kind: 'link', source, target, points: this.points() });
      if (this.project) await post('jobs', { kind: 'decide', of: this.project, link: id });
      byId('link').close();
      say(this.project ? 'Started: see the jobs. The link is kept for the next run of the project.' : 'Started: see the jobs.');
      await refresh();
    } catch (error) { this.say(error.message, true); }
  },
};

const layer = (side, pose = kStill) => (linking.sides[side] ? [{ points: linking.sides[side], colour: side ? kBlue : kOrange, pose }] : []);
const planViews = [new Plan('plan-source', () => layer(0)), new Plan('plan-target', () => layer(1)),
  new Plan('plan-both', () => (linking.ready() ? [...layer(1), ...layer(0, linking.pose)] : []))];
for (const side of [0, 1]) {
  planViews[side].onPick = (at) => linking.pick(side, at);
  planViews[side].marks = () => linking.places[side];
}
planViews[2].onDrag = (from, to, turns) => linking.drag(from, to, turns);

/** Scans of a project, or files: two of them are linked. */
const openLink = (names, source, target, project = null) => {
  linking.project = project;
  fill(byId('link-source'), names, source);
  fill(byId('link-target'), names, target);
  byId('link-source').value = source;
  byId('link-target').value = target;
  byId('link').showModal();
  linking.load();
};
const isScan = (name) => !/\.(ifc|ifczip|obj)$/i.test(name);

byId('link-source').onchange = byId('link-target').onchange = () => linking.load();
byId('link-height').oninput = byId('link-all').onchange = () => {
  byId('link-at').textContent = `${(+byId('link-height').value).toFixed(1)} m`;
  linking.show();
};
byId('link-undo').onclick = () => linking.undo();
byId('link-clear').onclick = () => linking.clear();
byId('link-go').onclick = () => linking.go();
byId('link-close').onclick = () => byId('link').close();
byId('link-files').onclick = () => openLink(state.files.map(({ name }) => name).filter(isScan), byId('source').value, byId('target').value);
new ResizeObserver(() => { for (const plan of planViews) plan.draw(); }).observe(byId('link'));
