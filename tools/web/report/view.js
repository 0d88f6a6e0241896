// The interactive skeleton: slider, threshold, picture, hovering, and its table.
import { Camera, control } from '../camera.js'
import { onThemeChange } from '../colors.js'
import { count, digitsFor, parseThreshold, shortNumber, thresholdText } from '../data.js'
import { SvgPicture } from './flat.js'
import { kNoThreshold, refuse, take } from '../note.js'
import { WebglPicture } from './scene.js'
import { makeTable } from '../table.js'

const kMostRows = 300 // of the table of arcs
const kLegibleNodes = 200 // of the level that is shown first, beside those of the coarsest level
const kReach = 9 // pixels from the pointer

export class SkeletonView {
  // `up`: the axis that points upwards.
  constructor(skeleton, up, announce) {
    this.skeleton = skeleton
    this.announce = announce
    this.camera = new Camera(up)
    this.place = document.getElementById('canvas-place')
    this.tooltip = document.getElementById('tooltip')
    this.slider = document.getElementById('level')
    this.input = document.getElementById('threshold')
    this.drawn = document.getElementById('drawn')
    this.table = document.getElementById('level-arcs')
    this.message = document.getElementById('skeleton-message')
    document.getElementById('skeleton-view').hidden = false
    this.message.hidden = true
    this.picture = this.makePicture()
    this.connect()
    this.reset()
    this.setLevel(this.firstLevel())
  }

  makePicture() {
    try {
      return new WebglPicture(this.place, this.skeleton)
    } catch {
      this.place.replaceChildren()
      this.message.textContent =
        'This browser has no WebGL, so the skeleton is drawn as lines without depth. Everything else works.'
      this.message.hidden = false
      return new SvgPicture(this.place, this.skeleton)
    }
  }

  connect() {
    this.slider.max = this.skeleton.levelCount - 1
    this.slider.disabled = this.skeleton.levelCount < 2
    this.slider.addEventListener('input', () => this.setLevel(Number(this.slider.value)))
    this.input.addEventListener('change', () => this.setThreshold(this.input.value))
    for (const button of document.querySelectorAll('[data-view]'))
      button.addEventListener('click', () => {
        this.reset({ x: 0, y: 1, z: 2 }[button.dataset.view])
        this.redraw()
      })
    const reset = () => this.reset()
    control(this.place, this.camera, { changed: () => this.redraw(), hovered: (at) => this.hover(at), reset })
    new ResizeObserver(() => this.redraw()).observe(this.place)
    this.table.addEventListener('toggle', () => this.fillTable())
    onThemeChange(() => {
      this.picture.recolor()
      this.picture.show(this.content)
      this.redraw()
    })
    const { min, size } = this.skeleton.values
    this.digits = digitsFor(min, min + size)
    document.getElementById('scale-min').textContent = shortNumber(min, this.digits)
    document.getElementById('scale-max').textContent = shortNumber(min + size, this.digits)
  }

  // The finest one that is not too crowded to read. What no level loses, as two nodes of each component, does not count.
  firstLevel() {
    const { nodes } = this.skeleton.levels
    const always = nodes[this.skeleton.levelCount - 1]
    return nodes.findIndex((count) => count <= always + kLegibleNodes)
  }

  setThreshold(text) {
    const threshold = parseThreshold(text.trim(), this.skeleton.values.size)
    if (threshold === null) {
      refuse(this.input, kNoThreshold)
      return this.announce(kNoThreshold)
    }
    this.setLevel(this.skeleton.levelAt(threshold), text.trim())
  }

  // `typed`: the threshold that was asked for, if it was.
  setLevel(level, typed = null) {
    const { threshold } = this.skeleton.levels
    this.content = this.skeleton.at(level)
    this.slider.value = level
    const text = thresholdText(threshold[level], (number) => this.skeleton.levelAt(number) === level)
    this.input.value = typed ?? text
    take(this.input, this.input.value === text ? '' : `level ${text}`)
    const percent = this.skeleton.values.size > 0 ? (100 * threshold[level]) / this.skeleton.values.size : 0
    const loops = this.content.arcs.length - this.content.nodes.length + this.components()
    const counts = [
      count(this.content.nodes.length, 'node'),
      count(this.content.arcs.length, 'arc'),
      count(loops, 'loop'),
    ].join(', ')
    this.slider.setAttribute('aria-valuetext', `${Number(percent.toPrecision(3))} per cent of the range: ${counts}`)
    const which = threshold[level] > 0 ? `Features below ${Number(percent.toPrecision(3))} % of the range are removed` : 'The full graph'
    this.drawn.textContent = `${which}: ${counts}.`
    Object.assign(this.drawn.dataset, {
      nodes: this.content.nodes.length,
      arcs: this.content.arcs.length,
      loops,
      threshold: threshold[level],
    })
    this.picture.show(this.content)
    this.place.setAttribute('aria-label', `The skeleton in space: ${counts}`)
    this.fillTable()
    this.redraw()
  }

  reset(axis) {
    this.camera.reset(axis)
    this.camera.fit(this.skeleton.points(), Math.max(1, this.place.clientWidth), Math.max(1, this.place.clientHeight))
  }

  components() {
    const parent = new Map(this.content.nodes.map((node) => [node, node]))
    const find = (node) => {
      while (parent.get(node) !== node) {
        parent.set(node, parent.get(parent.get(node)))
        node = parent.get(node)
      }
      return node
    }
    let components = this.content.nodes.length
    for (const arc of this.content.arcs) {
      const [a, b] = [find(this.skeleton.arcs.lo[arc]), find(this.skeleton.arcs.hi[arc])]
      if (a === b) continue
      parent.set(a, b)
      --components
    }
    return components
  }

  redraw() {
    if (this.waiting) return
    this.waiting = requestAnimationFrame(() => {
      this.waiting = 0
      this.picture.draw(this.camera, Math.max(1, this.place.clientWidth), Math.max(1, this.place.clientHeight))
    })
  }

  // What is nearest to the pointer; nodes come before arcs.
  nearest([x, y]) {
    const project = this.camera.projector(this.place.clientWidth, this.place.clientHeight)
    let best = { distance: kReach }
    this.content.nodes.forEach((node, i) => {
      const [px, py] = project(this.skeleton.place(node))
      const distance = Math.hypot(px - x, py - y) - 3
      if (distance < best.distance) best = { distance, node, kind: this.content.kinds[i] }
    })
    if (best.node !== undefined) return best
    for (const arc of this.content.arcs) {
      const line = this.skeleton.line(arc).map(({ at }) => project(at))
      for (let i = 1; i < line.length; ++i) {
        const distance = toSegment([x, y], line[i - 1], line[i])
        if (distance < best.distance) best = { distance, arc }
      }
    }
    return best
  }

  // A frame that waits is never cancelled: where frames are slow, a moving pointer would put it off for ever.
  hover(pointer) {
    this.pointer = pointer
    if (this.hovering) return
    this.hovering = requestAnimationFrame(() => {
      this.hovering = 0
      const at = this.pointer
      const found = at ? this.nearest(at) : {}
      this.tooltip.hidden = found.node === undefined && found.arc === undefined
      if (this.tooltip.hidden) return
      this.tooltip.textContent = found.node === undefined ? this.describeArc(found.arc) : this.describeNode(found)
      const left = at[0] + 14 + this.tooltip.offsetWidth > this.place.clientWidth ? at[0] - 14 - this.tooltip.offsetWidth : at[0] + 14
      this.tooltip.style.left = `${Math.max(0, left)}px`
      this.tooltip.style.top = `${Math.max(0, Math.min(at[1] + 14, this.place.clientHeight - this.tooltip.offsetHeight))}px`
    })
  }

  describeNode({ node, kind }) {
    const names = { min: 'Minimum', max: 'Maximum', saddle: 'Fork', isolated: 'Isolated point' }
    const { vertex, value } = this.skeleton.nodes
    return `${names[kind]} at vertex ${vertex[node]}\nvalue ${shortNumber(value[node], this.digits)}\n${this.content.down.get(node) ?? 0} down, ${this.content.up.get(node) ?? 0} up`
  }

  describeArc(arc) {
    const { vertex, value } = this.skeleton.nodes
    const [lo, hi] = [this.skeleton.arcs.lo[arc], this.skeleton.arcs.hi[arc]]
    const end = this.skeleton.endOf(arc)
    return `Arc from vertex ${vertex[lo]} to ${vertex[hi]}\nvalues ${shortNumber(value[lo], this.digits)} to ${shortNumber(value[hi], this.digits)}\n${end === null ? 'stays at all levels' : `changes at threshold ${thresholdText(end)}`}`
  }

  fillTable() {
    if (!this.table.open) return
    const { vertex, value } = this.skeleton.nodes
    const rows = this.content.arcs.slice(0, kMostRows).map((arc) => {
      const [lo, hi] = [this.skeleton.arcs.lo[arc], this.skeleton.arcs.hi[arc]]
      const end = this.skeleton.endOf(arc)
      return [vertex[lo], vertex[hi], shortNumber(value[lo], this.digits), shortNumber(value[hi], this.digits), end === null ? 'never' : thresholdText(end)]
    })
    const some = this.content.arcs.length > rows.length ? `The first ${rows.length} of ` : ''
    const caption = `${some}${count(this.content.arcs.length, 'arc')} of this level`
    this.table.querySelector('.scroll').replaceChildren(
      makeTable(caption, ['lower vertex', 'upper vertex', 'from value', 'to value', 'changes at threshold'], rows),
    )
  }

  // Marks the two nodes of a pair, and shows them large.
  showPair([type, low, high, lowVertex, highVertex, lowPlace, highPlace]) {
    const heights = (place, value) => this.skeleton.placeOf(this.skeleton.hasPositions ? place : [0, 0, value])
    const places = [heights(lowPlace, low), heights(highPlace, high)]
    this.picture.choose(places)
    const distance = Math.hypot(...places[0].map((x, k) => x - places[1][k]))
    const middle = places[0].map((x, k) => (x + places[1][k]) / 2)
    this.camera.lookAt(middle, Math.min(12, Math.max(1, 1 / Math.max(distance, 1e-6))))
    // A feature that this level no longer has is shown in one that has it.
    if (high - low < this.skeleton.levels.threshold[this.content.level]) this.setLevel(this.skeleton.levelAt(high - low))
    this.redraw()
    this.place.scrollIntoView({ block: 'center' })
    this.place.focus({ preventScroll: true })
    this.announce(`${type} from vertex ${lowVertex} to ${highVertex}, persistence ${shortNumber(high - low)}, is marked in the skeleton.`)
  }

  // Paper gets lines that stay sharp.
  print() {
    if (this.picture instanceof SvgPicture) return this.drawAgain()
    const picture = new SvgPicture(this.place, this.skeleton)
    picture.show(this.content)
    picture.draw(this.camera, Math.max(1, this.place.clientWidth), Math.max(1, this.place.clientHeight))
    this.place.classList.add('printed')
    this.printed = picture
  }

  endPrint() {
    if (this.picture instanceof SvgPicture) this.drawAgain()
    this.printed?.element.remove()
    this.printed = null
    this.place.classList.remove('printed')
  }

  // At once, in the colours of now.
  drawAgain() {
    this.picture.recolor()
    this.picture.draw(this.camera, Math.max(1, this.place.clientWidth), Math.max(1, this.place.clientHeight))
  }
}

function toSegment([x, y], a, b) {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]]
  const length = dx * dx + dy * dy
  const t = length > 0 ? Math.min(1, Math.max(0, ((x - a[0]) * dx + (y - a[1]) * dy) / length)) : 0
  return Math.hypot(a[0] + t * dx - x, a[1] + t * dy - y)
}
