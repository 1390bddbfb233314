import { tables } from './tables.js';

// The pictures of a report, which lie in the page itself: deflated half floats as base64.
export class ReportSource {
  constructor(data) {
    this.data = data;
  }
  async capture() { return { ...this.data.capture, partial: true, first: this.data.pairs[0] }; }
  async tables() { return this.data.tables; }
  async shader() { return this.data.shader; }
  async pixels(kind, where, level) {
    const pair = this.pair(where), picture = kind === 'flip' ? this.flip(pair, where) : pair?.[kind];
    if (!picture) throw Object.assign(new Error(`no ${kind} in this report`), { status: 404 });
    const bytes = Uint8Array.from(atob(picture), c => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
    const planes = new Uint8Array(await new Response(stream).arrayBuffer());
    // High bytes first, then low ones: equal bytes side by side deflate better. A map has one value a pixel.
    const count = planes.length / 2, step = count === pair.width * pair.height ? 4 : 1, data = new Uint16Array(step * count);
    for (let i = 0; i < count; ++i) data[step * i] = (planes[i] << 8) | planes[count + i];
    return { width: pair.width, height: pair.height, data };
  }
  pair(where) {
    const at = new URLSearchParams(where);
    return this.data.pairs.find(p => p.camera === at.get('camera') && p.light === at.get('light'));
  }
  // The program filters FLIP, so that the report holds the maps of one exposure and view only; HDR-FLIP has its own.
  flip(pair, where) {
    const metric = new URLSearchParams(where).get('metric'), made = pair?.flips[metric];
    const free = metric === 'hdr_flip' ? ['ev', 'view', ...tables.fields.filter(f => f.view).map(f => f.name)] : [];
    const asked = new URLSearchParams(where), held = new URLSearchParams(made?.state);
    for (const name of [...free, 'camera', 'light', 'variant']) for (const text of [asked, held]) text.delete(name);
    if (asked.toString() !== held.toString()) throw new Error(`this report holds ${metric} without match gain only` + (free.length ? '' : `, at EV ${held.get('ev') ?? 0} and view ${held.get('view') ?? 'gt'}`));
    return made.map;
  }
  async exposure(where) { return this.pair(where)?.exposures ?? {}; }
  async gain(where) {
    const at = new URLSearchParams(where), pair = this.pair(where);
    const match = at.get('match') ?? 'none', noise = Number(at.get('noise') ?? 0) || (pair?.noise ?? 1e-4);
    return { gain: pair?.gains[match] ?? [1, 1, 1], noise };
  }
  async frame(where) {
    return this.pair(where)?.frame;
  }
  async scores(metric) { return this.data.scores.find(s => s.metric === metric) ?? this.data.scores[0]; }
}
