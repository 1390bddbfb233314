// The lights as dots on a disc, as seen from the shown camera: its middle is the light at the camera, the ring at half of
// the radius lights at a right angle, the rim light from straight behind (equal areas, Lambert 1772).
const kSvg = 'http://www.w3.org/2000/svg';

const kHint = 'Lights as the camera sees them. Middle: from the camera; rim: from behind.';

// world_from_camera has the camera's axes as columns: x right, y down, z away from it.
function discOf(light, axes) {
  const d = [0, 1, 2].map(column => [0, 1, 2].reduce((sum, row) => sum + axes[row][column] * light.direction[row], 0));
  const side = Math.hypot(d[0], d[1]), r = Math.sqrt(Math.max(0, (1 + d[2]) / 2));
  return side > 1e-9 ? { r, x: (r * d[0]) / side, y: (r * d[1]) / side } : { r, x: 0, y: 0 };
}

export class Sphere {
  constructor(root, pick) {
    this.root = root;
    this.pick = pick;
    root.setAttribute('role', 'listbox');
    root.setAttribute('tabindex', '0');
  }

  // `lights`: id, label, direction; `axes`: rows of world_from_camera; `colors`, `texts`: of each light.
  show({ lights, axes, current, colors, texts, present }) {
    const key = JSON.stringify([axes, lights.length]);
    if (this.key !== key) this.build(key, lights, axes);
    this.dots.forEach((dot, i) => {
      dot.setAttribute('fill', colors[i] ?? 'var(--dot)');
      dot.setAttribute('aria-selected', i === current);
      dot.setAttribute('aria-label', `light ${lights[i].label || lights[i].id}${texts[i] ? ', ' + texts[i] : ''}`);
      dot.classList.toggle('absent', !present[i]);
      dot.classList.toggle('current', i === current);
    });
    if (this.dots[current]) {
      this.root.append(this.dots[current]);  // drawn last
      this.root.setAttribute('aria-activedescendant', this.dots[current].id);
    }
  }

  build(key, lights, axes) {
    this.key = key;
    this.root.replaceChildren();
    const make = (name, attributes) => {
      const element = document.createElementNS(kSvg, name);
      for (const [k, v] of Object.entries(attributes)) element.setAttribute(k, v);
      this.root.append(element);
      return element;
    };
    make('circle', { cx: 0, cy: 0, r: 1, class: 'disc' });
    // Lights in a narrow cone are drawn farther apart, up to the rim.
    const farthest = Math.max(...lights.map(light => (light.direction ? discOf(light, axes).r : 1)));
    const spread = farthest > 1e-3 && farthest < 0.6 ? 0.92 / farthest : 1;
    make('circle', { cx: 0, cy: 0, r: Math.min(1, Math.SQRT1_2 * spread), class: 'ring' });
    const hint = this.root.parentElement?.querySelector('.hint');
    if (hint) hint.textContent = spread === 1 ? kHint : `Lights as the camera sees them, drawn ${spread.toFixed(1)} × as far from the middle, which is at the camera.`;
    make('path', { d: 'M-1 0H1M0 -1V1', class: 'ring' });
    const radius = Math.min(0.06, Math.max(0.022, 0.55 / Math.sqrt(lights.length)));
    let lost = 0;
    this.dots = lights.map((light, i) => {
      let [x, y] = [0, 0];
      if (light.direction) {
        const at = discOf(light, axes);
        [x, y] = [at.x * spread, at.y * spread];
      } else {
        const turn = 2.39996 * lost, r = 0.95 * Math.sqrt((++lost - 0.5) / lights.length);  // a place of its own at least
        [x, y] = [r * Math.cos(turn), r * Math.sin(turn)];
      }
      const dot = make('circle', { cx: x.toFixed(4), cy: y.toFixed(4), r: radius, class: 'dot', role: 'option', id: 'light' + i });
      const title = document.createElementNS(kSvg, 'title');
      title.textContent = light.label || light.id;
      dot.append(title);
      dot.addEventListener('click', () => this.pick(i));
      return dot;
    });
  }
}
