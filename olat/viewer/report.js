// The pictures of a report, which lie in the page itself: deflated half floats as base64.
export class ReportSource {
  constructor(data) {
    this.data = data;
  }
  async capture() { return { ...this.data.capture, partial: true }; }
  async tables() { return this.data.tables; }
  async shader() { return this.data.shader; }
  async pixels(kind, where, level) {
    const at = new URLSearchParams(where), pair = this.data.pairs.find(p => p.camera === at.get('camera') && p.light === at.get('light'));
    const picture = pair?.[kind];
    if (!picture) throw Object.assign(new Error(`no ${kind} in this report`), { status: 404 });
    const bytes = Uint8Array.from(atob(picture), c => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
    const planes = new Uint8Array(await new Response(stream).arrayBuffer());
    // High bytes first, then low ones: equal bytes side by side deflate better.
    const data = new Uint16Array(planes.length / 2);
    for (let i = 0; i < data.length; ++i) data[i] = (planes[i] << 8) | planes[data.length + i];
    return { width: pair.width, height: pair.height, data };
  }
  async gain(where) {
    const at = new URLSearchParams(where), pair = this.data.pairs.find(p => p.camera === at.get('camera') && p.light === at.get('light'));
    const match = at.get('match') ?? 'none', noise = Number(at.get('noise') ?? 0) || (pair?.noise ?? 1e-4);
    return { gain: pair?.gains[match] ?? [1, 1, 1], noise };
  }
  async frame(where) {
    const at = new URLSearchParams(where);
    return this.data.pairs.find(p => p.camera === at.get('camera') && p.light === at.get('light'))?.frame;
  }
  async scores(metric) { return this.data.scores.find(s => s.metric === metric) ?? this.data.scores[0]; }
}
