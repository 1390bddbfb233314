// The page: one state, one picture, and the parts that show and change it.
import { tables, takeTables, fieldNamed } from './tables.js';
import { initialState, stateOf, textOf, addressOf, pipelineOf, hashOf, kept, numberText } from './state.js';
import { Painter } from './shader.js';
import { Pictures, ServerSource } from './pictures.js';
import { Stage, metricText } from './stage.js';
import { Sphere } from './sphere.js';
import { Matrix, colorOf } from './matrix.js';
import { showProbe, binsOf, showHistogram, showProvenance, showWedge } from './side.js';
import { Keys, keyOf, makeActions, neighbours, commandOf } from './actions.js';
import { showHelp, showPalette } from './dialogs.js';
import { byId, buildControls, showControls } from './controls.js';
import { Region } from './region.js';
import { Thumbs } from './thumbs.js';
import { ReportSource } from './report.js';

class Viewer {
  async start() {
    const report = byId('report');
    const token = location.hash.slice(1);
    this.source = report ? new ReportSource(JSON.parse(report.textContent)) : new ServerSource(token);
    const [capture, lists, shader] = await Promise.all([this.source.capture(), this.source.tables(), this.source.shader()]);
    takeTables(lists);
    this.capture = capture;
    this.keys = new Keys();
    const canvas = byId('picture');
    const gl = canvas.getContext('webgl2', { antialias: false, alpha: false });
    if (!gl) throw new Error('this browser has no WebGL 2, which the pictures need');
    this.painter = new Painter(gl, shader);
    canvas.addEventListener('webglcontextlost', event => { event.preventDefault(); this.complain('the graphics context was lost: reload the page'); });
    this.pictures = new Pictures(this.painter, this.source, entry => { if (entry?.error) this.say(entry.error); this.redraw(); });
    this.pictures.initial = initialState();

    const query = report ? location.hash.slice(1) : location.search, { state, faults } = stateOf(query);
    this.state = state;
    if (capture.first && !state.camera) Object.assign(state, { camera: capture.first.camera, light: capture.first.light });
    if (!new URLSearchParams(query).has('ev')) state.ev = kept(capture.pipeline.ev);
    this.exposing = state.ev === 0 && !new URLSearchParams(query).has('ev');
    this.seen = new Set();
    this.versions = {};
    this.lastSingle = 'photo';
    if (!location.search && !report) this.state.match = capture.pipeline.match;
    if (!location.search && fieldNamed('view').words.includes(capture.pipeline.view)) this.state.view = capture.pipeline.view;
    this.findPlace();
    this.region = new Region(this, [byId('region'), byId('region_right')]);
    this.stage = new Stage(this, canvas, byId('split'), byId('cross'));
    this.sphere = new Sphere(byId('sphere'), light => this.goto(this.place.camera, light));
    this.matrix = new Matrix(byId('matrix'), byId('matrix_note'), at => this.goto(at.camera, at.light));
    this.thumbs = new Thumbs(this, byId('thumbs'));
    this.actions = makeActions(this);
    buildControls(this);
    this.bookmarks = this.readBookmarks();
    document.addEventListener('keydown', event => this.key(event));
    document.addEventListener('keyup', event => { if (event.code === this.held?.code) this.release(); });
    addEventListener('blur', () => this.release());
    if (report) addEventListener('hashchange', () => this.follow(location.hash.slice(1)));
    byId('name').textContent = capture.name || capture.root || 'capture';
    document.title = (capture.name || 'capture') + ' – Likeness';
    if (faults.length) this.say('not understood: ' + faults.join(', '));
    this.change({});
    this.exposed = capture.pipeline.by ?? null;
    if (this.exposing) {
      this.stage.layout();
      this.stage.ask();
      this.expose('percentile');
    }
    this.pollScores();
    document.body.dataset.ready = '1';
  }

  // Positions of the state's ids; the first pair that there is for ids that are not.
  findPlace() {
    const index = (list, id) => Math.max(0, list.findIndex(item => item.id === id));
    const { cameras, lights, variants } = this.capture;
    this.place = { camera: index(cameras, this.state.camera), light: index(lights, this.state.light) };
    if (!this.has(this.place.camera, this.place.light) && !this.state.light) this.place.light = Math.max(0, this.capture.photos[this.place.camera].indexOf('1'));
    this.state.camera = cameras[this.place.camera].id;
    this.state.light = lights[this.place.light].id;
    if (!variants.includes(this.state.variant)) this.state.variant = this.capture.variant ?? '';
  }
  get camera() { return this.capture.cameras[this.place.camera]; }
  has(camera, light) { return this.capture.photos[camera]?.[light] === '1'; }
  stateAt(camera, light) {
    return { ...this.state, camera: this.capture.cameras[camera].id, light: this.capture.lights[light].id };
  }
  // `by` photos further, past what is not there, no further than the last.
  presentLight(light, by) {
    const all = this.capture.lights.length, camera = this.place.camera;
    let left = Math.abs(by), last = light;
    for (let at = light + Math.sign(by); at >= 0 && at < all && left > 0; at += Math.sign(by))
      if (this.has(camera, at)) [last, left] = [at, left - 1];
    return last;
  }
  presentCamera(camera, by) {
    for (let at = camera + by; at >= 0 && at < this.capture.cameras.length; at += by)
      if (this.capture.photos[at].includes('1')) return at;
    return camera;
  }
  goto(camera, light) {
    if (!this.has(camera, light)) {
      const other = this.capture.photos[camera].indexOf('1');
      if (this.capture.partial) return this.say('this pair is not in the report');
      if (other >= 0 && camera !== this.place.camera) light = other;
    }
    this.change({ camera: this.capture.cameras[camera].id, light: this.capture.lights[light].id });
  }

  // The only way that the state changes.
  change(part) {
    for (const [name, value] of Object.entries(part)) this.state[name] = typeof value === 'number' ? kept(value) : value;
    if ('ev' in part) this.exposing = this.exposed = null;
    if (['photo', 'render'].includes(this.state.mode)) this.lastSingle = this.state.mode;
    this.findPlace();
    this.seen.add(this.state.camera + '/' + this.state.light);
    if (['camera', 'light', 'variant'].some(name => name in part)) {
      this.wentAt = performance.now();
      this.stage.ask();
    }
    this.redraw();
    showControls(this);
    this.announce(part);
    clearTimeout(this.remembering);
    this.remembering = setTimeout(() => this.remember(), 300);
  }
  remember() {
    if (this.capture.partial) return;
    history.replaceState(null, '', '?' + addressOf(this.held ? { ...this.state, mode: this.held.mode } : this.state) + location.hash);
  }
  // What a link names of the state; the rest stays.
  follow(text) {
    const { state } = stateOf(text);
    this.change(Object.fromEntries([...new URLSearchParams(text).keys()].filter(name => name in state).map(name => [name, state[name]])));
  }

  // Takes the exposure that the program finds for the photo; what else sets it meanwhile has the last word.
  async expose(by) {
    const asked = this.exposing = {}, { camera, light, variant, noise } = this.state;
    const found = await this.source.exposure(textOf({ ...initialState(), camera, light, variant, noise })).catch(() => ({}));
    if (this.exposing !== asked) return;
    this.exposing = null;
    if (Number.isFinite(found[by])) {
      this.change({ ev: found[by] });
      this.exposed = by;
    } else {
      if (this.drawnState) this.say('there is no picture to expose for');
      this.redraw();
    }
  }

  redraw() {
    if (this.requested || !this.stage) return;
    this.requested = true;
    requestAnimationFrame(() => {
      this.requested = false;
      this.draw();
    });
  }
  draw() {
    this.complete = false;
    // The first picture waits for its exposure: a black one before it would be a flash.
    if (this.exposing && !this.drawnState) return;
    try {
      this.complete = this.stage.draw();
    } catch (error) {
      return this.complain(error.message);
    }
    this.showHud();
    showWedge(byId('wedge'), this.stage, this.state.ev);
    this.probe();
    byId('loading').hidden = this.complete;
    if (!this.complete) return;
    this.drawnState = textOf(this.state);
    clearTimeout(this.later);
    this.later = setTimeout(() => this.afterwards(), 60);
  }
  // What can wait until the picture is there.
  afterwards() {
    const { photo, render } = this.stage.shownEntries, ev = this.state.ev;
    showHistogram(byId('histogram'), photo?.data && binsOf(photo, ev, [1, 1, 1], photo.data), render?.data && binsOf(render, ev, this.stage.pair.gain, photo?.width === render.width ? photo.data : null));
    this.region.show();
    this.pictures.prefetch(neighbours(this), this.stage.level());
    const where = this.state.camera + '/' + this.state.light + '/' + this.state.variant;
    if (this.framed !== where) {
      this.framed = where;
      this.source.frame(textOf({ ...initialState(), camera: this.state.camera, light: this.state.light, variant: this.state.variant }))
        .then(frame => { if (this.framed === where) showProvenance(byId('provenance'), frame); }, () => {});
    }
    this.showMaps();
    this.thumbs.show();
  }

  showMaps() {
    const row = this.scores?.rows?.[this.place.camera] ?? [], { lights } = this.capture;
    this.sphere.show({
      lights, axes: this.camera.world_from_camera, current: this.place.light,
      colors: lights.map((_, i) => colorOf(row[i], this.state.metric)),
      texts: lights.map((_, i) => (row[i] === null || row[i] === undefined ? '' : `${this.state.metric} ${row[i]}`)),
      present: [...this.capture.photos[this.place.camera]].map(flag => flag === '1'),
    });
    this.matrix.show({ capture: this.capture, scores: this.scores, camera: this.place.camera, light: this.place.light });
  }

  async pollScores() {
    clearTimeout(this.polling);
    const asked = this.state.metric + this.state.variant;
    try {
      const found = await this.source.scores(this.state.metric, this.state.variant, this.state.camera);
      if (asked === this.state.metric + this.state.variant) this.scores = found;
      byId('lost').hidden = true;
    } catch (error) {
      if (!error.status) byId('lost').hidden = false;
    }
    this.scoresOf = asked;
    this.showMaps();
    this.takeReceived(this.scores?.received ?? {});
    const done = this.scores && this.scores.known >= this.scores.all && !this.scores.received;
    if (!this.capture.partial) this.polling = setTimeout(() => this.pollScores(), done ? 10000 : 1000);
  }

  // Renders that tev's protocol brought, by their versions.
  takeReceived(received) {
    const select = byId('c_variant'), { variants } = this.capture;
    for (const [id, version] of Object.entries(received)) {
      if (!variants.includes(id)) {
        variants.push(id);
        select.append(new Option(id, id));
        select.closest('label').hidden = variants.length < 2;
        this.say(`received: ${id}; Shift Q shows it`);
      }
      if (this.versions[id] && this.versions[id] !== version) {
        this.pictures.refresh(id);
        this.redraw();
      }
      this.versions[id] = version;
    }
    if (!this.state.variant && variants.length) this.change({ variant: variants[0] });
  }

  // Tags over the picture: what each pane is, and the pipeline that it passed.
  showHud() {
    const { state } = this, gain = this.stage.pair.gain, hash = hashOf(pipelineOf(state));
    const absent = kind => this.stage.shownEntries[kind]?.absent, broken = kind => this.stage.shownEntries[kind]?.error;
    const tag = (id, text, kinds) => {
      const lost = kinds.filter(absent);
      byId(id).querySelector('b').textContent = text;
      byId(id).querySelector('code').textContent = hash;
      byId(id).querySelector('i').textContent = lost.map(kind => (broken(kind) ? `${kind} cannot be read` : `no ${kind}`)).join(', ');
      byId(id).dataset.hash = hash;
    };
    const names = { photo: ['PHOTO', ['photo']], render: ['RENDER', ['render']], wipe: ['PHOTO', ['photo']], side: ['PHOTO', ['photo']], onion: ['PHOTO + RENDER', ['photo', 'render']], difference: ['PHOTO − RENDER', ['photo', 'render']] };
    tag('tag_left', ...names[state.mode]);
    tag('tag_right', 'RENDER', ['render']);
    byId('tag_right').hidden = !['wipe', 'side'].includes(state.mode);
    byId('alarm').hidden = byId('tag_left').dataset.hash === byId('tag_right').dataset.hash;
    const stops = gain.map(v => Math.log2(v)), text = v => (v >= 0 ? '+' : '−') + Math.abs(v).toFixed(2);
    byId('hud').textContent = [
      `EV ${text(state.ev)}${this.exposed ? ` (${tables.exposures[this.exposed].word})` : ''}`,
      'match ' + state.match + (state.match === 'none' ? '' : ' ' + (state.match === 'channel' ? stops.map(text).join(' ') : text(stops[1])) + ' stops'),
      'view ' + state.view,
      state.mode === 'difference' ? metricText(state, this.stage.pair.noise) : '',
      state.channel === 'color' ? '' : state.channel === 'signed' && state.mode !== 'difference' ? `signed: blue −${Number((2 ** -state.ev).toPrecision(3))}, orange +${Number((2 ** -state.ev).toPrecision(3))}` : state.channel,
      `${Math.round(100 * this.stage.window.zoom)} %`,
    ].filter(Boolean).join('   ');
    byId('hud').title = this.exposed ? tables.exposures[this.exposed].text : '';
  }

  probe() {
    cancelAnimationFrame(this.probing);
    this.probing = requestAnimationFrame(() => showProbe(byId('probe'), this.stage.values(), this.state.ev));
  }

  // --- words ------------------------------------------------------------------------------------------------------
  // For who hears the page: what changed, or where it is.
  announce(part) {
    const names = Object.keys(part), { state } = this;
    if (names.some(name => ['camera', 'light'].includes(name))) {
      const value = this.scores?.rows?.[this.place.camera]?.[this.place.light];
      this.tell(`camera ${state.camera}, light ${state.light}, ${state.mode}` + (value === null || value === undefined ? '' : `, ${state.metric} ${value}`));
    } else if (names.length) {
      this.tell(names.map(name => `${name} ${fieldNamed(name)?.kind === 'number' ? numberText(state[name]) : state[name]}`).join(', '));
    }
  }
  tell(text) { byId('live').textContent = text; }
  say(text) {
    this.tell(text);
    const toast = byId('toast');
    toast.textContent = text;
    toast.hidden = false;
    clearTimeout(this.toasting);
    this.toasting = setTimeout(() => { toast.hidden = true; }, 4000);
  }
  complain(text) {
    byId('fault').textContent = text;
    byId('fault').hidden = false;
  }

  // --- actions ----------------------------------------------------------------------------------------------------
  key(event) {
    if (this.taking) {
      if (['Shift', 'Control', 'Alt', 'Meta'].includes(event.key)) return;
      event.preventDefault();
      return this.taking(keyOf(event));
    }
    const target = event.target, typing = target.matches?.('input:not([type=range]):not([type=checkbox]), textarea');
    const steering = target.matches?.('select, input[type=range]') && /^(Arrow|Home|End|Page|[a-z0-9 ]$)/i.test(event.key);
    const pressing = target.matches?.('button, summary, input[type=checkbox], a') && [' ', 'Enter'].includes(event.key);
    if (byId('dialog').open || typing || steering || pressing || event.altKey) return;
    const key = keyOf(event), action = this.keys.actionOf(key);
    if (!action) return;
    event.preventDefault();
    if (action.id === 'hold' && event.repeat) return;
    this.run(action.id, key);
    if (action.id === 'hold' && this.held) this.held.code = event.code;
  }
  run(id, key = '1') {
    if (id !== 'auto_flip') this.stopFlip();
    this.actions[id](key);
  }
  // The photo instead of the render, the render instead of the photo, and the photo instead of both.
  hold(key) {
    const keys = this.keys.of(tables.actions.find(action => action.id === 'hold'));
    if (!keys.includes(key)) return this.say('hold ' + keys[0]);
    if (this.held) return;
    this.held = { mode: this.state.mode, single: this.lastSingle };
    this.change({ mode: this.state.mode === 'photo' ? 'render' : 'photo' });
  }
  release() {
    if (!this.held) return;
    const { mode, single } = this.held;
    this.held = null;
    this.change({ mode });
    this.lastSingle = single;
  }
  autoFlip() {
    if (this.flipping) return this.stopFlip();
    if (matchMedia('(prefers-reduced-motion: reduce)').matches) return this.say('not by itself: your system asks for less motion. Space flips.');
    this.flipping = setInterval(() => this.actions.flip(), 1000);
    this.say('flips once a second; any key stops');
  }
  stopFlip() {
    clearInterval(this.flipping);
    this.flipping = null;
  }
  gotoWorst() {
    const next = this.matrix.worst().find(at => this.has(at.camera, at.light) && !this.seen.has(this.capture.cameras[at.camera].id + '/' + this.capture.lights[at.light].id));
    if (next) this.goto(next.camera, next.light);
    else this.say(this.scores?.rows ? 'every pair that is compared has been seen' : 'no pairs are compared yet');
  }
  bookmarkKey() { return 'likeness-bookmarks ' + (this.capture.root ?? this.capture.name); }
  readBookmarks() {
    try { return JSON.parse(localStorage.getItem(this.bookmarkKey()) ?? '{}'); } catch { return {}; }
  }
  store(key) {
    this.bookmarks[key] = textOf(this.state);
    try { localStorage.setItem(this.bookmarkKey(), JSON.stringify(this.bookmarks)); } catch { /* private window */ }
    this.say(`bookmark ${key}: ${this.state.camera}, ${this.state.light}, ${this.state.mode}`);
  }
  recall(key) {
    if (!this.bookmarks[key]) return this.say(`bookmark ${key} is empty; Ctrl ${key} keeps this state`);
    this.change(stateOf(this.bookmarks[key]).state);
  }
  async copy(text, otherwise) {
    if (!text) return this.say(otherwise);
    try {
      await navigator.clipboard.writeText(text);
      this.say('copied: ' + text);
    } catch {
      this.say(text);
    }
  }
  togglePanels() {
    document.body.classList.toggle('bare');
    this.redraw();
    this.showMaps();
  }
  help() { showHelp(this, byId('dialog')); }
  palette() { showPalette(this, byId('dialog')); }
  // The state of a text, its text again, and the pipeline's digits.
  parse(text) { return stateOf(text).state; }
  text() { return textOf(this.state); }
  textAgain(text) { return textOf(stateOf(text).state); }
  hashOfText(text) { return hashOf(pipelineOf(stateOf(text).state)); }
  close() {
    if (byId('dialog').open) byId('dialog').close();
    else if (this.region.rect) this.region.clear();
    else if (this.stage.pinned) this.stage.pin();
    else byId('picture').focus();
  }
}

const likeness = new Viewer();
window.likeness = likeness;
likeness.start().catch(error => {
  const fault = byId('fault');
  fault.textContent = error.status === 403 ? 'The token is missing or wrong. Open the address that the program printed.' : error.message;
  fault.hidden = false;
});
