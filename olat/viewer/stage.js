// The middle of the page: one canvas, its panes, and what the pointer does on it.
import { metricNamed } from './tables.js';
import { floatOfHalf, flawsAt } from './half.js';

const kLate = 400;  // [ms]

export class Stage {
  // `app`: state, change(part), pictures, painter.
  constructor(app, canvas, handle, cross) {
    Object.assign(this, { app, canvas, handle, cross });
    this.window = { width: 1, height: 1, pane: 1, origin: [0, 0], zoom: 1, wedge: 0 };
    this.size = { width: 1, height: 1 };
    this.pinned = null;
    this.pointer = null;
    new ResizeObserver(() => app.redraw()).observe(canvas);
    canvas.addEventListener('pointerdown', event => this.down(event));
    canvas.addEventListener('pointermove', event => this.move(event));
    for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, () => { this.drag = null; });
    canvas.addEventListener('pointerleave', () => { if (!this.drag) { this.pointer = null; app.probe(); } });
    canvas.addEventListener('wheel', event => this.wheel(event), { passive: false });
    handle.addEventListener('pointerdown', event => { this.splitting = true; handle.setPointerCapture(event.pointerId); event.preventDefault(); });
    handle.addEventListener('pointermove', event => { if (this.splitting) this.splitAt(event); });
    handle.addEventListener('pointerup', () => { this.splitting = false; });
    handle.addEventListener('keydown', event => {
      const step = { ArrowLeft: -0.01, ArrowRight: 0.01 }[event.key];
      if (!step) return;
      event.stopPropagation();
      app.change({ split: Math.min(1, Math.max(0, app.state.split + step)) });
    });
  }

  get ratio() { return this.canvas.width / Math.max(1, this.canvas.clientWidth); }

  // Where the picture lies, in canvas pixels. The picture's own size is the camera's.
  layout() {
    const { state, camera } = this.app, canvas = this.canvas, ratio = Math.min(2, window.devicePixelRatio || 1);
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio)), height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    this.size = { width: camera.width || this.known?.width || 1, height: camera.height || this.known?.height || 1 };
    const pane = state.mode === 'side' ? Math.floor(width / 2) : width, wedge = state.wedge ? Math.floor(height / 12) : 0;
    const room = height - wedge, margin = state.mode === 'side' ? 4 : 0;
    const fit = Math.min((pane - 2 * margin) / this.size.width, room / this.size.height);
    const zoom = state.zoom > 0 ? state.zoom : fit > 1 ? Math.max(1, Math.floor(fit)) : fit;
    const [x, y] = state.zoom > 0 ? [state.x, state.y] : [0.5, 0.5];
    const origin = [Math.round(pane / 2 - x * this.size.width * zoom), Math.round(room / 2 - y * this.size.height * zoom)];
    this.window = { width, height, pane, origin, zoom, wedge };
  }

  // 1 / 2^level of the size is as much as the canvas can show.
  level() {
    const most = this.app.painter.gl.getParameter(this.app.painter.gl.MAX_TEXTURE_SIZE);
    let level = Math.max(0, Math.floor(Math.log2(1 / this.window.zoom) + 1e-6));
    while (Math.max(this.size.width, this.size.height) / 2 ** level > most) ++level;
    return Math.min(level, 12);
  }

  needs() {
    const { state } = this.app;
    return state.mode === 'difference' && ['flip', 'hdr_flip'].includes(state.metric) ? ['photo', 'render', 'flip'] : ['photo', 'render'];
  }
  // Sends for the pictures of the state before the next frame is due.
  ask() {
    for (const kind of this.needs()) this.app.pictures.find(kind, this.app.state, this.level());
  }

  draw() {
    const { app } = this, { state, pictures } = app;
    this.layout();
    pictures.frame = (pictures.frame ?? 0) + 1;
    const level = this.level(), needs = this.needs();
    const pair = { width: this.size.width, height: this.size.height, gain: [1, 1, 1], noise: 1e-4 };
    let complete = true;
    this.shownEntries = {};
    for (const kind of needs) {
      let entry = pictures.find(kind, state, level);
      if (!entry) {
        complete = false;
        entry = pictures.fallback(kind, state, level);
      }
      if (!entry) continue;
      entry.used = pictures.frame;
      this.shownEntries[kind] = entry;
      pair[kind] = entry.texture ?? null;
      pair[kind + '_width'] = entry.width;
    }
    // While a pair is on its way the last one stays, for a moment: grey between two pictures would be a flash, and a frame.
    clearTimeout(this.late);
    if (!complete && !Object.keys(this.shownEntries).length && performance.now() - app.wentAt < kLate) {
      this.pair = pair;
      this.late = setTimeout(() => app.redraw(), kLate);
      return false;
    }
    const gain = pictures.gain(state);
    if (gain) Object.assign(pair, { gain: gain.gain, noise: gain.noise });
    else complete = false;
    this.pair = pair;
    app.painter.draw(state, pair, this.window);
    this.marks();
    return complete;
  }

  // What stands on the canvas but is not in it: the wipe's handle and the probe's cross.
  marks() {
    const { state } = this.app, { origin, zoom } = this.window, ratio = this.ratio;
    this.handle.hidden = state.mode !== 'wipe';
    if (!this.handle.hidden) {
      const left = (origin[0] + state.split * this.size.width * zoom) / ratio;
      this.handle.style.left = Math.min(this.canvas.clientWidth, Math.max(0, left)) + 'px';
      this.handle.setAttribute('aria-valuenow', Math.round(100 * state.split));
    }
    this.app.region.place();
    this.cross.hidden = !this.pinned;
    if (this.pinned) {
      this.cross.style.left = (origin[0] + (this.pinned.x + 0.5) * zoom) / ratio + 'px';
      this.cross.style.top = (origin[1] + (this.pinned.y + 0.5) * zoom) / ratio + 'px';
    }
  }

  // The pixel of the picture under an event, or null; or the nearest that there is.
  pixelAt(event, isNearest = false) {
    const box = this.canvas.getBoundingClientRect(), { origin, zoom, pane } = this.window;
    let x = (event.clientX - box.left) * this.ratio;
    const y = (event.clientY - box.top) * this.ratio;
    if (x >= pane) x -= pane;
    const at = { x: Math.floor((x - origin[0]) / zoom), y: Math.floor((y - origin[1]) / zoom) };
    if (isNearest) return { x: Math.min(this.size.width - 1, Math.max(0, at.x)), y: Math.min(this.size.height - 1, Math.max(0, at.y)) };
    return at.x >= 0 && at.y >= 0 && at.x < this.size.width && at.y < this.size.height ? at : null;
  }

  splitAt(event) {
    const box = this.canvas.getBoundingClientRect(), { origin, zoom } = this.window;
    const x = ((event.clientX - box.left) * this.ratio - origin[0]) / (this.size.width * zoom);
    this.app.change({ split: Math.min(1, Math.max(0, x)) });
  }

  down(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.layout();
    this.drag = { x: event.clientX, y: event.clientY, origin: [...this.window.origin], corner: event.shiftKey ? this.pixelAt(event, true) : null };
  }
  move(event) {
    this.pointer = this.pixelAt(event);
    if (this.drag?.corner) {
      this.app.region.between(this.drag.corner, this.pixelAt(event, true));
    } else if (this.drag) {
      const { zoom, pane, height, wedge } = this.window;
      const left = this.drag.origin[0] + (event.clientX - this.drag.x) * this.ratio;
      const top = this.drag.origin[1] + (event.clientY - this.drag.y) * this.ratio;
      if (Math.hypot(event.clientX - this.drag.x, event.clientY - this.drag.y) < 4 && !this.drag.far) return;
      this.drag.far = true;
      this.centre((pane / 2 - left) / zoom / this.size.width, ((height - wedge) / 2 - top) / zoom / this.size.height, zoom);
    }
    this.app.probe();
  }
  wheel(event) {
    event.preventDefault();
    this.zoomBy(event.deltaY < 0 ? 1.25 : 0.8, event);
  }
  // Keys and wheel come faster than frames: what they start from is the state, not the last frame.
  zoomBy(factor, event) {
    this.layout();
    const { zoom, origin, pane, height, wedge } = this.window, box = this.canvas.getBoundingClientRect();
    const next = Math.min(64, Math.max(1 / 64, zoom * factor));
    let px = pane / 2, py = (height - wedge) / 2;
    if (event) {
      px = (event.clientX - box.left) * this.ratio;
      if (px >= pane) px -= pane;
      py = (event.clientY - box.top) * this.ratio;
    }
    const x = (px - origin[0]) / zoom, y = (py - origin[1]) / zoom;
    this.centre((x + (pane / 2 - px) / next) / this.size.width, (y + ((height - wedge) / 2 - py) / next) / this.size.height, next);
  }
  centre(x, y, zoom) {
    const within = v => Math.min(1, Math.max(0, v));
    this.app.change({ zoom, x: within(x), y: within(y) });
  }
  pin() {
    this.pinned = this.pinned ? null : this.pointer ?? { x: this.size.width >> 1, y: this.size.height >> 1 };
    this.marks();
    this.app.probe();
  }

  // Light of both pictures at the pinned pixel or under the pointer; `mean` pixels a side where a smaller level is held.
  values() {
    const at = this.pinned ?? this.pointer;
    if (!at) return null;
    const out = { ...at, gain: this.pair?.gain ?? [1, 1, 1], noise: this.pair?.noise ?? 1e-4 };
    for (const kind of ['photo', 'render']) {
      const entry = this.shownEntries?.[kind];
      if (!entry?.data) continue;
      const x = Math.min(entry.width - 1, Math.floor((at.x * entry.width) / this.size.width));
      const y = Math.min(entry.height - 1, Math.floor((at.y * entry.height) / this.size.height)), i = y * entry.width + x;
      out[kind] = [0, 1, 2].map(c => floatOfHalf(entry.data[4 * i + c]) * (kind === 'render' ? out.gain[c] : 1));
      out.mean = Math.max(1, Math.round(this.size.width / entry.width));
      if (kind === 'photo') out.flaws = flawsAt(entry.data, i);
    }
    return out;
  }

  // Display values of a rectangle of the canvas, from the top left (tests, and the wedge's labels).
  read(x, y, width, height) {
    this.draw();
    const gl = this.app.painter.gl, out = new Uint8Array(4 * width * height), turned = new Uint8Array(out.length);
    gl.readPixels(x, this.window.height - y - height, width, height, gl.RGBA, gl.UNSIGNED_BYTE, out);
    for (let row = 0; row < height; ++row) turned.set(out.subarray(4 * width * row, 4 * width * (row + 1)), 4 * width * (height - 1 - row));
    return turned;
  }
}

export function metricText(state, noise) {
  const metric = metricNamed(state.metric), scale = state.range > 0 ? state.range : metric.scale;
  const unit = metric.unit === '1' ? '' : ' ' + metric.unit;
  const floor = ['stops', 'smape'].includes(state.metric) ? `, n = ${noise.toPrecision(2)}` : '';
  return `${state.metric.replace('_', ' ')} ${metric.signed ? '±' : '0 to '}${scale}${unit}${floor}`;
}
