// Close-ups of defects: a patch of the surface with its curves, drawn from far to near on a plain canvas, which every
// browser has.
import { Camera, control } from '../camera.js'
import { css, rgb, valueColors } from '../colors.js'
import { numbers16, shortNumber } from '../data.js'

class Patch {
  constructor(json) {
    const places = numbers16(json.places)
    this.triangles = numbers16(json.triangles)
    this.curves = [json.curve, json.other]
    this.count = places.length / 4
    this.values = new Float32Array(this.count)
    this.points = []
    const most = [0, 0, 0]
    for (let v = 0; v < this.count; ++v) {
      const point = [0, 1, 2].map((k) => places[4 * v + k] / 65535)
      point.forEach((x, k) => (most[k] = Math.max(most[k], x)))
      this.points.push(point)
      this.values[v] = places[4 * v + 3] / 65535
    }
    const radius = Math.max(1e-6, Math.hypot(...most))
    this.points = this.points.map((point) => point.map((x, k) => ((x - most[k] / 2) * 2) / radius))
    const center = json.center.map((x, k) => (json.size > 0 ? (x - json.min[k]) / json.size : 0))
    this.center = center.map((x, k) => ((x - most[k] / 2) * 2) / radius)
    this.hasCurve = json.length !== null
  }

  // The largest distance of the shorter curve from its centre; 0 if it is not in the patch.
  reach() {
    const distances = this.curves[0].map((v) => Math.hypot(...this.points[v].map((x, k) => x - this.center[k])))
    return Math.max(0, ...distances)
  }

  // Looks along the axis of the curve, a bit from the side: so a handle or tunnel is seen as a hole.
  axis() {
    const curve = this.curves.find((list) => list.length > 2)
    if (!curve) return null
    const sum = [0, 0, 0]
    curve.forEach((v, i) => {
      const [a, b] = [this.points[v], this.points[curve[(i + 1) % curve.length]]]
      sum[0] += a[1] * b[2] - a[2] * b[1]
      sum[1] += a[2] * b[0] - a[0] * b[2]
      sum[2] += a[0] * b[1] - a[1] * b[0]
    })
    return Math.hypot(...sum) > 1e-9 ? sum : null
  }
}

const kSeenPixels = 8 // that a curve is large, at least, to be seen

function paint(canvas, patch, camera) {
  const ratio = Math.min(2, window.devicePixelRatio)
  const width = canvas.clientWidth || 240
  const height = canvas.clientHeight || 180
  canvas.width = width * ratio
  canvas.height = height * ratio
  const context = canvas.getContext('2d')
  context.setTransform(ratio, 0, 0, ratio, 0, 0)
  context.clearRect(0, 0, width, height)
  const project = camera.projector(width, height)
  const seen = patch.points.map(project)
  const color = valueColors()
  const { back, up } = camera.axes()
  const light = back.map((b, k) => 0.85 * b + 0.5 * up[k])
  const faces = []
  for (let t = 0; t < patch.triangles.length; t += 3) {
    const [a, b, c] = [patch.triangles[t], patch.triangles[t + 1], patch.triangles[t + 2]]
    const [p, q, r] = [patch.points[a], patch.points[b], patch.points[c]]
    const u = q.map((x, k) => x - p[k])
    const v = r.map((x, k) => x - p[k])
    const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    const length = Math.hypot(...normal) || 1
    // Both sides are lit: how the mesh is oriented does not matter here.
    const shade = Math.abs(normal.reduce((sum, n, k) => sum + n * light[k], 0)) / length
    faces.push({ a, b, c, depth: seen[a][2] + seen[b][2] + seen[c][2], shade })
  }
  faces.sort((f, g) => f.depth - g.depth)
  context.lineJoin = 'round'
  for (const { a, b, c, shade } of faces) {
    const base = color((patch.values[a] + patch.values[b] + patch.values[c]) / 3)
    const lit = base.map((x) => Math.min(1, (0.35 + 0.65 * shade) * (0.45 * x + 0.55 * 0.86)))
    context.fillStyle = context.strokeStyle = rgb(lit)
    context.lineWidth = 0.7 // closes the seams between triangles
    context.beginPath()
    context.moveTo(seen[a][0], seen[a][1])
    context.lineTo(seen[b][0], seen[b][1])
    context.lineTo(seen[c][0], seen[c][1])
    context.closePath()
    context.fill()
    context.stroke()
  }
  const styles = [{ color: css('--max'), dash: [] }, { color: css('--loop'), dash: [6, 4] }]
  const dot = ([x, y], color) => {
    context.beginPath()
    context.arc(x, y, 5, 0, 2 * Math.PI)
    context.fillStyle = color
    context.fill()
    context.strokeStyle = css('--paper')
    context.lineWidth = 2
    context.stroke()
  }
  // The longer one first, since the shorter one is what the picture is about.
  for (const i of [1, 0]) {
    const curve = patch.curves[i]
    const extent = curve.length > 0 ? extentOf(curve.map((v) => seen[v])) : null
    if (extent ? extent.size < kSeenPixels : i === 0 && patch.hasCurve) {
      dot(extent ? extent.middle : project(patch.center), styles[i].color)
      continue
    }
    if (!extent) continue
    context.beginPath()
    curve.forEach((v, k) => (k === 0 ? context.moveTo(seen[v][0], seen[v][1]) : context.lineTo(seen[v][0], seen[v][1])))
    context.closePath()
    context.setLineDash([])
    context.strokeStyle = css('--paper')
    context.lineWidth = 5
    context.stroke()
    context.setLineDash(styles[i].dash)
    context.strokeStyle = styles[i].color
    context.lineWidth = 2.5
    context.stroke()
    context.setLineDash([])
  }
}

function extentOf(places) {
  const [left, right, top, bottom] = [
    Math.min(...places.map(([x]) => x)), Math.max(...places.map(([x]) => x)),
    Math.min(...places.map(([, y]) => y)), Math.max(...places.map(([, y]) => y)),
  ]
  return { size: Math.max(right - left, bottom - top), middle: [(left + right) / 2, (top + bottom) / 2] }
}

// What the picture shows, as a caption.
function describe(json, patch) {
  const digits = (x, n) => shortNumber(Number(x.toPrecision(n)))
  const place = json.center.map((x) => digits(x, 5)).join(', ')
  const isDrawn = patch.curves[0].length > 0
  const curve = patch.hasCurve
    ? `curve ${digits(json.length, 3)} long at ${place}${isDrawn ? '' : ' (the dot is its centre)'}`
    : `at ${place}, between its nodes, as no curve was found near them`
  return `${curve}; picture ${digits(json.size, 3)} wide${json.limited ? '; only the nearest part' : ''}`
}

function makeFigure(json, index) {
  const patch = new Patch(json)
  const camera = new Camera()
  camera.mostZoom = Math.max(camera.mostZoom, 1 / Math.max(patch.reach(), 1e-5)) // till it fills the picture
  const axis = patch.axis()
  const reset = () => {
    camera.reset()
    if (axis) camera.lookAlong(axis)
    camera.fitAround(patch.center, patch.points, 240, 180)
  }
  reset()
  const figure = document.createElement('figure')
  figure.className = 'closeup'
  figure.id = `closeup-${index}`
  const canvas = document.createElement('canvas')
  canvas.tabIndex = 0
  canvas.setAttribute('role', 'img')
  canvas.setAttribute(
    'aria-label',
    `Close-up of defect ${index + 1}, ${json.kind}: ${describe(json, patch)}. Arrow keys rotate, + and − zoom, 0 resets.`,
  )
  const caption = document.createElement('figcaption')
  const title = document.createElement('strong')
  title.textContent = `Defect ${index + 1}: ${json.kind}`
  const detail = document.createElement('span')
  detail.className = 'quiet'
  detail.textContent = describe(json, patch)
  caption.append(title, detail)
  figure.append(canvas, caption)
  const draw = () => paint(canvas, patch, camera)
  control(canvas, camera, { changed: () => requestAnimationFrame(draw), reset })
  return { figure, draw }
}

// Draws all. Returns a function that shows the one of this row, and one that draws again.
export function makeCloseups(place, list) {
  const items = list.map(makeFigure)
  place.append(...items.map(({ figure }) => figure))
  const hint = document.createElement('p')
  hint.className = 'hint'
  hint.textContent =
    'Close-ups: solid, the shorter curve of the loop, in the middle; dashed, the other one; a dot, where a curve is too small to see. ' +
    'Indigo to orange: the value. Drag to rotate; click, then wheel, or + and −, to zoom; 0 resets.'
  if (items.length > 0) place.before(hint)
  const draw = () => items.forEach((item) => item.draw())
  draw()
  return {
    draw,
    show(index) {
      items.forEach(({ figure }, i) => figure.classList.toggle('chosen', i === index))
      items[index].figure.scrollIntoView({ block: 'nearest' })
      items[index].figure.querySelector('canvas').focus({ preventScroll: true })
    },
  }
}
