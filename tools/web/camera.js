// Where a shape is looked at from: around a point, with one axis up. Drag, wheel and keys change it.

export class Camera {
  // `up`: the axis that points upwards, 0 to 2.
  constructor(up = 2) {
    this.mostZoom = 60
    this.setUp(up)
    this.reset()
  }

  setUp(axis) {
    this.order = [(axis + 1) % 3, (axis + 2) % 3, axis]
  }

  // From the side, or along an axis.
  reset(axis) {
    this.turn = -0.9
    this.tilt = 0.3
    this.zoom = 1
    this.target = [0, 0, 0]
    if (axis === undefined) return
    this.turn = axis === this.order[1] ? Math.PI / 2 : axis === this.order[0] ? 0 : -Math.PI / 2
    this.tilt = axis === this.order[2] ? Math.PI / 2 : 0
  }

  // Along this direction, a bit from the side.
  lookAlong(direction) {
    const [x, y, z] = this.order.map((axis) => direction[axis])
    this.turn = Math.atan2(y, x) + 0.35
    this.tilt = Math.atan2(z, Math.hypot(x, y))
    this.rotate(0, 0.25)
  }

  // As large as the picture allows.
  fit(points, width, height) {
    const project = this.projector(width, height)
    let [left, right, top, bottom] = [Infinity, -Infinity, Infinity, -Infinity]
    for (const point of points) {
      const [x, y] = project(point)
      ;[left, right, top, bottom] = [Math.min(left, x), Math.max(right, x), Math.min(top, y), Math.max(bottom, y)]
    }
    if (!(left <= right)) return
    const side = Math.min(width, height)
    this.move((width / 2 - (left + right) / 2) / side, ((top + bottom) / 2 - height / 2) / side)
    const spare = 40 // pixels, for markers
    this.zoomBy(Math.min((width - spare) / Math.max(1, right - left), (height - spare) / Math.max(1, bottom - top)))
  }

  // As large as the picture allows with this point in its middle.
  fitAround(target, points, width, height) {
    this.lookAt(target, 1)
    const project = this.projector(width, height)
    let [across, down] = [1, 1]
    for (const point of points) {
      const [x, y] = project(point)
      across = Math.max(across, Math.abs(x - width / 2))
      down = Math.max(down, Math.abs(y - height / 2))
    }
    const spare = 6 // pixels
    this.zoomBy(Math.min((width / 2 - spare) / across, (height / 2 - spare) / down))
  }

  // Unit vectors to the right, up and towards the eye.
  axes() {
    const [ct, st, ci, si] = [Math.cos(this.turn), Math.sin(this.turn), Math.cos(this.tilt), Math.sin(this.tilt)]
    const turned = (vector) => [0, 1, 2].map((axis) => vector[this.order.indexOf(axis)])
    return { right: turned([-st, ct, 0]), up: turned([-ct * si, -st * si, ci]), back: turned([ct * ci, st * ci, si]) }
  }

  rotate(turn, tilt) {
    this.turn += turn
    this.tilt = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, this.tilt + tilt))
  }

  zoomBy(factor) {
    this.zoom = Math.min(this.mostZoom, Math.max(0.3, this.zoom * factor))
  }

  // By parts of the height of the picture.
  move(dx, dy) {
    const { right, up } = this.axes()
    this.target = this.target.map((t, k) => t - ((right[k] * dx + up[k] * dy) * 2.4) / this.zoom)
  }

  lookAt(point, zoom) {
    this.target = point
    this.zoom = zoom
  }

  // Pixels of a picture of this size for one unit of length.
  scale(width, height) {
    return (Math.min(width, height) / 2.4) * this.zoom
  }

  // A point in pixels of a picture of this size, and how near it is.
  projector(width, height) {
    const { right, up, back } = this.axes()
    const scale = this.scale(width, height)
    return (point) => {
      const d = point.map((p, k) => p - this.target[k])
      const along = (axis) => d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2]
      return [width / 2 + scale * along(right), height / 2 - scale * along(up), along(back)]
    }
  }
}

// Connects the camera with an element. `changed` is called after each move, `hovered` with the place of the pointer in
// the element, or null, `reset` for the first view.
export function control(element, camera, { changed, hovered = (_place) => {}, reset }) {
  const pointers = new Map()
  let spread = 0
  element.addEventListener('pointerdown', (event) => {
    pointers.set(event.pointerId, event)
    element.setPointerCapture(event.pointerId)
    hovered(null)
  })
  element.addEventListener('pointermove', (event) => {
    const before = pointers.get(event.pointerId)
    const box = element.getBoundingClientRect()
    if (!before) return hovered([event.clientX - box.left, event.clientY - box.top])
    const [dx, dy] = [event.clientX - before.clientX, event.clientY - before.clientY]
    pointers.set(event.pointerId, event)
    if (pointers.size === 2) {
      const [a, b] = [...pointers.values()]
      const distance = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY)
      if (spread > 0 && distance > 0) camera.zoomBy(distance / spread)
      spread = distance
      // Each finger moves the middle by half of its way.
      const side = 2 * Math.min(box.width, box.height)
      camera.move(dx / side, -dy / side)
    } else if (event.buttons & 2 || event.shiftKey) {
      const side = Math.min(box.width, box.height)
      camera.move(dx / side, -dy / side)
    } else {
      camera.rotate(-dx / 150, dy / 150)
    }
    changed()
  })
  const release = (event) => {
    pointers.delete(event.pointerId)
    spread = 0
  }
  element.addEventListener('pointerup', release)
  element.addEventListener('pointercancel', release)
  element.addEventListener('pointerleave', () => hovered(null))
  element.addEventListener('contextmenu', (event) => event.preventDefault())
  element.addEventListener(
    'wheel',
    (event) => {
      // Scrolling the page goes on, unless the picture was chosen first.
      if (document.activeElement !== element && !event.ctrlKey) return
      event.preventDefault()
      camera.zoomBy(Math.exp(-event.deltaY / 500))
      changed()
    },
    { passive: false },
  )
  element.addEventListener('keydown', (event) => {
    const moves = {
      ArrowLeft: () => camera.rotate(-0.1, 0),
      ArrowRight: () => camera.rotate(0.1, 0),
      ArrowUp: () => camera.rotate(0, 0.1),
      ArrowDown: () => camera.rotate(0, -0.1),
      '+': () => camera.zoomBy(1.25),
      '=': () => camera.zoomBy(1.25),
      '-': () => camera.zoomBy(0.8),
      0: reset,
    }
    const move = moves[event.key]
    if (!move || event.ctrlKey || event.metaKey || event.altKey) return
    event.preventDefault()
    move()
    changed()
  })
}
