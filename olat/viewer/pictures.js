// The pictures of a capture, from the server or from a report: fetched once, kept as textures up to a number of bytes,
// neighbours ahead of time.
import { textOf } from './state.js';

const kMostBytes = 400e6, kAhead = 2, kParallel = 1, kPartly = 120;  // one, so that the server has a thread left for what is asked for now

// From the program that serves the page. A source answers: capture(), tables(), shader(), pixels(), gain(), frame(),
// exposure(), scores().
export class ServerSource {
  constructor(token) {
    this.token = token;
  }
  async ask(path, parameters = {}, options = {}) {
    const query = new URLSearchParams(parameters).toString();
    const response = await fetch(path + (query ? '?' + query : ''), { headers: { 'X-Likeness-Token': this.token }, ...options });
    if (!response.ok) {
      const text = await response.text();
      let line = text;
      try { line = JSON.parse(text).error; } catch { /* not ours */ }
      throw Object.assign(new Error(line || response.statusText), { status: response.status });
    }
    return response;
  }
  async json(path, parameters) { return (await this.ask(path, parameters)).json(); }
  capture() { return this.json('/api/capture'); }
  tables() { return this.json('/api/tables'); }
  async shader() { return (await this.ask('/view.glsl')).text(); }
  async pixels(kind, where, level, options) {
    const response = await this.ask('/api/pixels', { kind, level, state: where }, options);
    const data = new Uint16Array(await response.arrayBuffer());
    return { width: +response.headers.get('X-Width'), height: +response.headers.get('X-Height'), data };
  }
  gain(where) { return this.json('/api/gain', { state: where }); }
  frame(where) { return this.json('/api/frame', { state: where }); }
  exposure(where) { return this.json('/api/exposure', { state: where }); }
  scores(metric, variant, camera) { return this.json('/api/scores', { metric, variant, camera }); }
}

export class Pictures {
  constructor(painter, source, changed) {
    Object.assign(this, { painter, source, changed });
    this.entries = new Map();  // by key, the last used at the end
    this.gains = new Map();
    this.bytes = 0;
    this.running = 0;
    this.queue = [];
  }

  // What of the state a picture depends on.
  where(kind, state) {
    const part = { camera: state.camera, light: state.light };
    if (kind !== 'photo') part.variant = state.variant;
    if (kind === 'flip') for (const name of Object.keys(state)) if (!['mode', 'split', 'mix', 'channel', 'overlay', 'zebra', 'wedge', 'zoom', 'x', 'y', 'range', 'noise'].includes(name)) part[name] = state[name];
    return textOf({ ...this.initial, ...part });
  }

  // The picture at that level, or null while it is on its way; a picture that is not there is {absent: true}. `fallback`:
  // another level of it, if there is one.
  find(kind, state, level) {
    const entry = this.entryOf(kind, this.where(kind, state), level, true);
    return entry.ready ? entry : null;
  }
  fallback(kind, state, level) {
    const where = this.where(kind, state);
    for (let other = 0; other < 8; ++other) {
      const entry = this.entries.get(`${kind} ${other} ${where}`);
      if (other !== level && entry?.ready) return entry;
    }
    return null;
  }

  entryOf(kind, where, level, now) {
    const key = `${kind} ${level} ${where}`;
    let entry = this.entries.get(key);
    if (entry) this.entries.delete(key);
    else entry = { key, kind, where, level, ready: false, waiting: true, bytes: 0 };
    this.entries.set(key, entry);
    if (now && !entry.ready) {
      entry.now = true;
      if (entry.waiting) this.start(entry);
    }
    return entry;
  }

  async start(entry) {
    entry.waiting = false;
    try {
      const picture = await this.source.pixels(entry.kind, entry.where, entry.level);
      this.drop(entry);
      Object.assign(entry, picture, { bytes: 2 * picture.data.byteLength });
      entry.texture = this.painter.texture(picture.width, picture.height, picture.data);
      this.bytes += entry.bytes;
      this.shrink(entry);
    } catch (error) {
      entry.absent = true;
      entry.error = error.status === 404 ? null : error.message;
    }
    entry.ready = true;
    if (!entry.now) return;
    entry.now = false;
    // One frame for a pair: the first of two waits for the second, if that is not long.
    clearTimeout(this.partly);
    if ([...this.entries.values()].some(other => other.now)) this.partly = setTimeout(() => this.changed(entry), kPartly);
    else this.changed(entry);
  }

  drop(entry) {
    if (!entry.texture) return;
    this.painter.gl.deleteTexture(entry.texture);
    this.bytes -= entry.bytes;
    entry.texture = null;
  }

  // Another version of these renders has arrived: what is shown stays until the new one is here.
  refresh(variant) {
    this.gains.clear();
    for (const [key, entry] of this.entries) {
      if (entry.kind === 'photo' || new URLSearchParams(entry.where).get('variant') !== variant) continue;
      if (entry.texture && entry.used === this.frame) {
        entry.now = true;
        this.start(entry);
      } else if (entry.ready) {
        this.drop(entry);
        this.entries.delete(key);
      }
    }
  }

  shrink(but) {
    for (const [key, entry] of this.entries) {
      if (this.bytes <= kMostBytes) return;
      if (entry === but || !entry.texture || entry.used === this.frame) continue;
      this.drop(entry);
      this.entries.delete(key);
    }
  }

  // Neighbours of a state, one after the other, while nothing else is on its way. The last call counts.
  prefetch(states, level) {
    this.queue = states.flatMap(state => ['photo', 'render'].map(kind => ({ kind, where: this.where(kind, state), level })));
    while (this.running < kParallel && this.queue.length) this.next();
  }
  async next() {
    const { kind, where, level } = this.queue.shift();
    const entry = this.entryOf(kind, where, level, false);
    if (entry.waiting) {
      ++this.running;
      await this.start(entry);
      --this.running;
    }
    if (this.queue.length && this.running < kParallel) this.next();
  }

  // Gain and noise floor, or null while they are on their way.
  gain(state) {
    const part = { camera: state.camera, light: state.light, variant: state.variant, match: state.match, noise: state.noise };
    const key = textOf({ ...this.initial, ...part });
    if (!this.gains.has(key)) {
      this.gains.set(key, null);
      this.source.gain(key).then(found => {
        this.gains.set(key, found);
        this.changed();
      }, error => {
        this.gains.set(key, { gain: [1, 1, 1], noise: 1e-4, error: error.message });
        this.changed();
      });
    }
    return this.gains.get(key);
  }
}

export { kAhead };
