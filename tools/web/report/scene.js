// The skeleton drawn by WebGL: lines of some width, and a marker for each node.
import {
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  Group,
  OrthographicCamera,
  Points,
  PointsMaterial,
  SRGBColorSpace,
  Scene,
  WebGLRenderer,
} from 'three'
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js'
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js'
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js'
import { css, kindColors, rgb, valueColors } from '../colors.js'
import { isSmall, kSmallMark } from '../marks.js'

const kShapes = {
  min: [[4, 10], [60, 10], [32, 58]],
  max: [[4, 54], [60, 54], [32, 6]],
  isolated: [[10, 10], [54, 10], [54, 54], [10, 54]],
  saddle: null, // a disc
}

const kMarkPixels = 12
const kWidths = [2, 3, 4, 5, 6] // of lines, in pixels

function markerTexture(shape, fill, rim) {
  const canvas = document.createElement('canvas')
  canvas.width = canvas.height = 64
  const context = canvas.getContext('2d')
  context.beginPath()
  if (shape) shape.forEach(([x, y], i) => (i === 0 ? context.moveTo(x, y) : context.lineTo(x, y)))
  else context.arc(32, 32, 24, 0, 2 * Math.PI)
  context.closePath()
  context.fillStyle = rgb(fill)
  context.fill()
  context.strokeStyle = rim
  context.lineWidth = 7
  context.lineJoin = 'round'
  context.stroke()
  const texture = new CanvasTexture(canvas)
  texture.colorSpace = SRGBColorSpace
  return texture
}

function ringTexture() {
  const canvas = document.createElement('canvas')
  canvas.width = canvas.height = 64
  const context = canvas.getContext('2d')
  context.strokeStyle = '#fff'
  context.lineWidth = 8
  context.beginPath()
  context.arc(32, 32, 26, 0, 2 * Math.PI)
  context.stroke()
  return new CanvasTexture(canvas)
}

// THROWS if there is no WebGL.
export class WebglPicture {
  constructor(place, skeleton) {
    this.skeleton = skeleton
    // What was drawn stays readable, also for the printer.
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true })
    this.camera = new OrthographicCamera(-1, 1, 1, -1, -100, 100)
    this.camera.matrixAutoUpdate = false
    this.scene = new Scene()
    this.group = new Group()
    this.scene.add(this.group)
    this.lineMaterials = kWidths.map((linewidth) => new LineMaterial({ linewidth, vertexColors: true }))
    this.lines = []
    this.markers = {}
    for (const kind of Object.keys(kShapes))
      this.markers[kind] = [kMarkPixels, kMarkPixels * kSmallMark].map((size) => {
        const material = new PointsMaterial({ size, sizeAttenuation: false })
        material.alphaTest = 0.5
        const points = new Points(new BufferGeometry(), material)
        points.renderOrder = 1
        return points
      })
    const ring = new PointsMaterial({ size: 26, sizeAttenuation: false, map: ringTexture(), depthTest: false })
    ring.alphaTest = 0.4
    this.chosen = new Points(new BufferGeometry(), ring)
    this.chosen.renderOrder = 2
    this.chosen.visible = false
    this.group.add(...Object.values(this.markers).flat(), this.chosen)
    this.element = this.renderer.domElement
    place.append(this.element)
    this.recolor()
  }

  recolor() {
    this.color = valueColors()
    const kinds = kindColors()
    for (const [kind, points] of Object.entries(this.markers)) {
      const texture = markerTexture(kShapes[kind], kinds[kind], css('--rim'))
      points[0].material.map?.dispose()
      for (const { material } of points) Object.assign(material, { map: texture, needsUpdate: true })
    }
    this.chosen.material.color.setRGB(...kinds.max, 'srgb')
  }

  show(content) {
    this.content = content
    this.marked = 0
    const parts = kWidths.map(() => ({ positions: [], colors: [] }))
    for (const arc of content.arcs) {
      const line = this.skeleton.line(arc)
      for (let i = 1; i < line.length; ++i) {
        const width = Math.round((line[i - 1].width + line[i].width) / 2)
        const { positions, colors } = parts[Math.max(0, kWidths.indexOf(width))]
        positions.push(...line[i - 1].at, ...line[i].at)
        for (const point of [line[i - 1], line[i]]) colors.push(...this.color(point.value).map(linear))
      }
    }
    for (const lines of this.lines) {
      this.group.remove(lines)
      lines.geometry.dispose()
    }
    this.lines = parts.flatMap(({ positions, colors }, i) => {
      if (positions.length === 0) return []
      const geometry = new LineSegmentsGeometry()
      geometry.setPositions(positions)
      geometry.setColors(colors)
      const lines = new LineSegments2(geometry, this.lineMaterials[i])
      lines.frustumCulled = false
      this.group.add(lines)
      return [lines]
    })
  }

  // At a zoom of this scale.
  setMarks(scale) {
    if (!this.content || scale === this.marked) return
    this.marked = scale
    const { nodes, kinds, rooms } = this.content
    for (const [kind, points] of Object.entries(this.markers))
      for (const [i, marks] of points.entries())
        setPoints(marks, nodes.flatMap((node, k) => (kinds[k] === kind && isSmall(rooms[k], scale) === (i === 1) ? this.skeleton.place(node) : [])))
  }

  choose(places) {
    setPoints(this.chosen, places.flat())
  }

  draw(camera, width, height) {
    const ratio = Math.min(2, window.devicePixelRatio) // changes when the page is zoomed
    if (width !== this.width || height !== this.height || ratio !== this.ratio) {
      this.renderer.setPixelRatio(ratio)
      this.renderer.setSize(width, height, false)
      ;[this.width, this.height, this.ratio] = [width, height, ratio]
    }
    const scale = camera.scale(width, height)
    this.setMarks(scale)
    Object.assign(this.camera, {
      left: -width / 2 / scale,
      right: width / 2 / scale,
      top: height / 2 / scale,
      bottom: -height / 2 / scale,
    })
    this.camera.updateProjectionMatrix()
    const { right, up, back } = camera.axes()
    const [x, y, z] = camera.target
    this.camera.matrix.set(right[0], up[0], back[0], x, right[1], up[1], back[1], y, right[2], up[2], back[2], z, 0, 0, 0, 1)
    this.camera.matrixWorldNeedsUpdate = true
    for (const material of this.lineMaterials) material.resolution.set(width, height)
    this.renderer.render(this.scene, this.camera)
  }
}

function setPoints(points, places) {
  points.geometry.dispose()
  points.geometry = new BufferGeometry()
  points.geometry.setAttribute('position', new BufferAttribute(new Float32Array(places), 3))
  points.frustumCulled = false
  points.visible = places.length > 0
}

// Vertex colours are linear, those of the style are not.
function linear(c) {
  return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4
}
