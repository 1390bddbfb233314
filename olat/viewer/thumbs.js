// A small picture of each camera, where there is more than one: fetched when it comes into sight, one after the other,
// kept, and drawn by the shader that draws the large one.
import { initialState, textOf } from './state.js';

const kSide = 96;  // longest side [pixel]

export class Thumbs {
  constructor(app, root) {
    Object.assign(this, { app, root, queue: [], running: false });
    const { cameras, photos } = app.capture;
    this.all = [];
    root.hidden = cameras.length < 2;
    if (root.hidden) return;
    cameras.forEach((camera, index) => {
      if (!photos[index].includes('1')) return;
      const button = document.createElement('button'), canvas = document.createElement('canvas'), name = document.createElement('span');
      name.textContent = camera.label || camera.id;
      canvas.setAttribute('aria-hidden', 'true');
      button.type = 'button';
      button.title = button.ariaLabel = `camera ${name.textContent}`;
      button.append(canvas, name);
      button.addEventListener('click', () => app.goto(index, app.place.light));
      root.append(button);
      this.all.push({ camera: index, button, canvas });
    });
    const seen = new IntersectionObserver(entries => {
      for (const entry of entries) {
        const thumb = this.all.find(t => t.button === entry.target);
        if (!entry.isIntersecting || thumb.asked) continue;
        thumb.asked = true;
        this.queue.push(thumb);
      }
      if (app.complete) this.next();
    }, { root });
    this.all.forEach(thumb => seen.observe(thumb.button));
  }

  // After each frame: the shown camera, and what is still to be fetched or has another exposure or view.
  show() {
    if (this.root.hidden) return;
    const { app } = this;
    for (const { camera, button } of this.all) button.setAttribute('aria-pressed', camera === app.place.camera);
    if (this.current !== app.place.camera) {
      this.current = app.place.camera;
      const button = this.all.find(t => t.camera === this.current)?.button;
      if (button) this.root.scrollTop = Math.min(button.offsetTop, Math.max(this.root.scrollTop, button.offsetTop + button.offsetHeight - this.root.clientHeight));
    }
    for (const thumb of this.all) if (thumb.picture && thumb.drawn !== this.look()) this.draw(thumb);
    this.next();
  }
  look() { return textOf(this.state()); }
  state() {
    const { state } = this.app, out = initialState();
    for (const name of Object.keys(out)) if (name === 'ev' || name === 'view' || name.startsWith('gt_')) out[name] = state[name];
    return out;
  }

  async next() {
    if (this.running || !this.queue.length) return;
    this.running = true;
    const thumb = this.queue.shift(), { app } = this, { cameras, lights, photos } = app.capture;
    // The light that is shown, whose photo the large picture may want next.
    const light = app.has(thumb.camera, app.place.light) ? app.place.light : photos[thumb.camera].indexOf('1');
    const camera = cameras[thumb.camera], most = Math.max(camera.width, camera.height);
    const level = Math.min(12, most > 0 ? Math.max(0, Math.ceil(Math.log2(most / kSide))) : 3);
    try {
      const where = textOf({ ...initialState(), camera: camera.id, light: lights[light].id });
      const { width, height, data } = await app.source.pixels('photo', where, level);
      thumb.picture = { width, height, texture: app.painter.texture(width, height, data) };
      this.draw(thumb);
    } catch {
      thumb.canvas.classList.add('absent');
    }
    this.running = false;
    this.next();
  }

  draw(thumb) {
    const { painter } = this.app, { gl } = painter, { texture } = thumb.picture;
    const zoom = Math.min(1, kSide / Math.max(thumb.picture.width, thumb.picture.height));
    const width = Math.max(1, Math.round(zoom * thumb.picture.width)), height = Math.max(1, Math.round(zoom * thumb.picture.height));
    const target = gl.createTexture(), frame = gl.createFramebuffer(), pixels = new Uint8ClampedArray(4 * width * height);
    gl.bindTexture(gl.TEXTURE_2D, target);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, width, height, 0, gl.RGBA, gl.UNSIGNED_BYTE, null);
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
    painter.draw(this.state(), { width: thumb.picture.width, height: thumb.picture.height, photo: texture, photo_width: thumb.picture.width, render: null, gain: [1, 1, 1], noise: 1e-4 },
      { width, height, pane: width, origin: [0, 0], zoom: width / thumb.picture.width, wedge: 0 });
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.deleteFramebuffer(frame);
    gl.deleteTexture(target);
    const image = new ImageData(width, height);
    for (let y = 0; y < height; ++y) image.data.set(pixels.subarray(4 * width * (height - 1 - y), 4 * width * (height - y)), 4 * width * y);
    Object.assign(thumb.canvas, { width, height });
    thumb.canvas.getContext('2d').putImageData(image, 0, 0);
    thumb.drawn = this.look();
  }
}
