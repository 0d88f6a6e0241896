// A shape drawn by WebGL. All arcs that were read are on the graphics card; a number says which version is drawn, so
// the slider costs no work per arc.
import {
  BufferAttribute, BufferGeometry, Color, DoubleSide, InstancedBufferAttribute, InstancedBufferGeometry, Mesh, OrthographicCamera,
  Points, Scene, ShaderMaterial, Vector2, WebGLRenderer,
} from 'three'
import type { Camera } from '../../web/camera.js'
import { channels, kindColors, valueStops } from '../../web/colors.js'
import { kSmallMark } from '../../web/marks.js'
import type { LoadedGraph, VersionContent } from '../reading/loaded_graph'
import { kLargeRoom, makeShape, roomsOf } from './shapes'
import type { Shape } from './shapes'

export type Coloring = 'value' | 'arc' | 'type'
export const kColorings: Coloring[] = ['value', 'arc', 'type']
export const kNoArc = 2 ** 32 - 1

// Kinds of nodes in buffers; 0 is not drawn.
export const kKinds = ['none', 'min', 'max', 'saddle', 'isolated'] as const

const kLineVertex = `
  attribute vec2 corner;
  attribute vec3 start;
  attribute vec3 end;
  attribute vec2 part;
  attribute uvec2 life;
  attribute uint arc;
  attribute float type;
  uniform uint version, chosen;
  uniform vec2 size;
  uniform float width;
  uniform int coloring;
  uniform vec3 stops[4];
  uniform vec3 kinds[5];
  uniform vec3 mark;
  varying vec3 tint;
  vec3 ofArc(uint number) {
    float hue = fract(float(number % 4096u) * 0.61803398875) * 6.0;
    return 0.25 + 0.6 * clamp(abs(mod(hue + vec3(0.0, 4.0, 2.0), 6.0) - 3.0) - 1.0, 0.0, 1.0);
  }
  void main() {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    if (version < life.x || version >= life.y) return;
    mat4 all = projectionMatrix * modelViewMatrix;
    vec4 a = all * vec4(start, 1.0), b = all * vec4(end, 1.0);
    vec2 along = (b.xy - a.xy) * size;
    along = length(along) > 1e-6 ? normalize(along) : vec2(1.0, 0.0);
    float wide = arc == chosen ? 3.0 * width : width;
    vec4 at = mix(a, b, corner.x);
    at.xy += (vec2(-along.y, along.x) * corner.y + along * (corner.x - 0.5)) * wide / size;
    if (arc == chosen) at.z -= 0.001;
    gl_Position = at;
    float p = clamp(mix(part.x, part.y, corner.x), 0.0, 1.0) * 3.0;
    tint = mix(stops[0], stops[1], min(p, 1.0));
    if (p > 1.0) tint = mix(stops[1], stops[2], min(p - 1.0, 1.0));
    if (p > 2.0) tint = mix(stops[2], stops[3], p - 2.0);
    if (coloring == 1) tint = ofArc(arc);
    if (coloring == 2) tint = kinds[int(type)];
    if (arc == chosen) tint = mark;
  }`
const kPointVertex = `
  attribute float kind;
  attribute float room;
  uniform vec3 kinds[5];
  uniform float width, scale;
  varying vec3 tint;
  varying float shape;
  void main() {
    gl_Position = kind < 0.5 ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    gl_Position.z -= 0.0005;
    gl_PointSize = room * scale < 1.0 ? ${kSmallMark} * width : width;
    shape = kind;
    tint = kinds[int(kind + 0.5)];
  }`
const kPointFragment = `
  uniform vec3 rim;
  varying vec3 tint;
  varying float shape;
  float triangle(vec2 p) { return min(0.9 * ((0.9 - p.y) * 0.5 - abs(p.x)), p.y + 0.7); }
  void main() {
    vec2 p = gl_PointCoord * 2.0 - 1.0;
    // How far inside of the mark.
    float inside = shape < 1.5 ? triangle(p) : shape < 2.5 ? triangle(vec2(p.x, -p.y))
      : shape < 3.5 ? 0.74 - length(p) : shape < 4.5 ? 0.7 - max(abs(p.x), abs(p.y))
      : min(1.0 - length(p), length(p) - 0.77);
    if (inside < 0.0) discard;
    gl_FragColor = vec4(inside < 0.18 && shape < 4.5 ? rim : tint, 1.0);
  }`
// As if by X-rays: a surface is denser where it is seen from the side.
const kBackdropVertex = `
  varying vec3 place;
  void main() {
    vec4 seen = modelViewMatrix * vec4(position, 1.0);
    place = seen.xyz;
    gl_Position = projectionMatrix * seen;
  }`
const kBackdropFragment = `
  uniform vec3 tint;
  varying vec3 place;
  void main() {
    vec3 across = cross(dFdx(place), dFdy(place));
    float facing = length(across) > 0.0 ? abs(normalize(across).z) : 1.0;
    gl_FragColor = vec4(tint, mix(0.5, 0.07, facing));
  }`
const kRing = 5
const kPointPixels = 12
const kRingPixels = 30

export interface Found {
  node?: number
  arc?: number
}

// THROWS if there is no WebGL.
export class Picture {
  readonly element: HTMLCanvasElement
  private readonly renderer: WebGLRenderer
  private readonly camera = new OrthographicCamera(-1, 1, 1, -1, -100, 100)
  private readonly scene = new Scene()
  private readonly lineMaterial: ShaderMaterial
  private readonly pointMaterial: ShaderMaterial
  private readonly ringMaterial: ShaderMaterial
  private lines: Mesh | null = null
  private points: Points | null = null
  private rings: Points | null = null
  private readonly backdropMaterial: ShaderMaterial
  private backdrop: Mesh | null = null
  private shape: Shape | null = null
  private kinds = new Uint8Array(0)
  private rooms = new Float32Array(0)
  private version = 0
  private size = [0, 0]
  private ratio = 0

  // `restored` is called when the graphics card has lost everything and is there again.
  constructor(place: HTMLElement, restored: () => void) {
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true })
    this.camera.matrixAutoUpdate = false
    const colors = (count: number) => ({ value: Array.from({ length: count }, () => new Color()) })
    this.lineMaterial = new ShaderMaterial({
      vertexShader: kLineVertex,
      fragmentShader: 'varying vec3 tint; void main() { gl_FragColor = vec4(tint, 1.0); }',
      uniforms: {
        version: { value: 0 }, chosen: { value: kNoArc }, size: { value: new Vector2(1, 1) }, width: { value: 2.2 },
        coloring: { value: 0 }, stops: colors(4), kinds: colors(kKinds.length), mark: { value: new Color() },
      },
      side: 2,
    })
    const points = (kinds: object, depthTest: boolean) =>
      new ShaderMaterial({
        vertexShader: kPointVertex, fragmentShader: kPointFragment, depthTest,
        uniforms: { kinds, rim: { value: new Color() }, width: { value: 0 }, scale: { value: 1 } } as never,
      })
    this.pointMaterial = points(colors(kKinds.length), true)
    this.ringMaterial = points(colors(kKinds.length + 1), false)
    this.ringMaterial.vertexShader = kPointVertex.replace('kinds[5]', 'kinds[6]')
    this.backdropMaterial = new ShaderMaterial({
      vertexShader: kBackdropVertex, fragmentShader: kBackdropFragment, uniforms: { tint: { value: new Color() } },
      side: DoubleSide, transparent: true, depthWrite: false,
    })
    this.element = this.renderer.domElement
    place.append(this.element)
    this.element.addEventListener('webglcontextrestored', restored)
    this.recolor()
    // Shaders are compiled now, while the first bytes of a file are on their way.
    this.setShape(makeShape(new Float32Array(3), 1, 1))
    this.choose(0, [0])
    this.renderer.compile(this.scene, this.camera)
    this.choose(kNoArc, [])
  }

  recolor() {
    const { uniforms } = this.lineMaterial
    valueStops().forEach((stop, i) => uniforms.stops.value[i].fromArray(stop))
    const kinds: Record<string, number[]> = kindColors()
    const points = this.pointMaterial.uniforms
    kKinds.forEach((kind, i) => kind !== 'none' && points.kinds.value[i].fromArray(kinds[kind]))
    points.rim.value.fromArray(channels('--rim'))
    // A line has no rim, so one between forks cannot be white.
    const ofLines: Record<string, number[]> = { ...kinds, saddle: channels('--quiet') }
    kKinds.forEach((kind, i) => kind !== 'none' && uniforms.kinds.value[i].fromArray(ofLines[kind]))
    uniforms.mark.value.fromArray(channels('--accent'))
    this.ringMaterial.uniforms.kinds.value[kRing].fromArray(channels('--accent'))
    this.backdropMaterial.uniforms.tint.value.fromArray(channels('--quiet'))
  }

  setShape(shape: Shape) {
    this.shape = shape
    this.remove(this.lines)
    this.remove(this.points)
    const geometry = new InstancedBufferGeometry()
    const corners = new Float32Array([0, -1, 1, -1, 1, 1, 0, 1])
    geometry.setAttribute('corner', new BufferAttribute(corners, 2))
    geometry.setIndex([0, 1, 2, 0, 2, 3])
    for (const [name, size] of [['start', 3], ['end', 3], ['part', 2], ['life', 2], ['arc', 1]] as const)
      geometry.setAttribute(name, new InstancedBufferAttribute(shape[name], size))
    geometry.setAttribute('type', new InstancedBufferAttribute(new Uint8Array(shape.arc.length), 1))
    geometry.instanceCount = shape.arc.length
    this.lines = new Mesh(geometry, this.lineMaterial)
    this.lines.frustumCulled = false
    this.kinds = new Uint8Array(shape.nodes.length / 3)
    this.rooms = new Float32Array(this.kinds.length)
    const nodes = new BufferGeometry()
    nodes.setAttribute('position', new BufferAttribute(shape.nodes, 3))
    nodes.setAttribute('kind', new BufferAttribute(this.kinds, 1))
    nodes.setAttribute('room', new BufferAttribute(this.rooms, 1))
    this.points = new Points(nodes, this.pointMaterial)
    this.points.frustumCulled = false
    this.points.renderOrder = 1
    this.scene.add(this.lines, this.points)
  }

  // `kinds`: of each node, as in kKinds. `types`: of each arc, in the same numbers; null where they are not shown.
  show(graph: LoadedGraph, content: VersionContent, kinds: Uint8Array, types: Uint8Array | null) {
    const { version } = content
    this.version = version
    this.lineMaterial.uniforms.version.value = version
    if (!this.shape || !this.points || !this.lines) return
    this.kinds.set(kinds.subarray(0, this.kinds.length)) // more nodes can have been read than the shape has
    this.rooms.set(roomsOf(graph, content, this.shape).subarray(0, this.rooms.length))
    for (const name of ['kind', 'room']) this.points.geometry.attributes[name].needsUpdate = true
    if (!types) return
    const attribute = this.lines.geometry.attributes.type
    for (let i = 0; i < this.shape.arc.length; ++i) attribute.array[i] = types[this.shape.arc[i]]
    attribute.needsUpdate = true
  }

  // Null: none.
  setBackdrop(geometry: BufferGeometry | null) {
    this.remove(this.backdrop)
    this.backdrop = geometry && new Mesh(geometry, this.backdropMaterial)
    if (this.backdrop) this.scene.add(this.backdrop)
  }

  setColoring(coloring: Coloring) {
    this.lineMaterial.uniforms.coloring.value = kColorings.indexOf(coloring)
  }

  choose(arc: number, nodes: number[]) {
    this.lineMaterial.uniforms.chosen.value = arc
    this.remove(this.rings)
    this.rings = null
    if (!this.shape || nodes.length === 0) return
    const geometry = new BufferGeometry()
    const places = nodes.flatMap((node) => [...this.shape!.nodes.subarray(3 * node, 3 * node + 3)])
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(places), 3))
    geometry.setAttribute('kind', new BufferAttribute(new Uint8Array(nodes.length).fill(kRing), 1))
    geometry.setAttribute('room', new BufferAttribute(new Float32Array(nodes.length).fill(kLargeRoom), 1))
    this.rings = new Points(geometry, this.ringMaterial)
    this.rings.frustumCulled = false
    this.rings.renderOrder = 2
    this.scene.add(this.rings)
  }

  draw(camera: Camera, width: number, height: number) {
    const ratio = Math.min(2, devicePixelRatio) // changes when the page is zoomed
    if (width !== this.size[0] || height !== this.size[1] || ratio !== this.ratio) {
      this.renderer.setPixelRatio(ratio)
      this.renderer.setSize(width, height, false)
      this.pointMaterial.uniforms.width.value = kPointPixels * ratio
      this.ringMaterial.uniforms.width.value = kRingPixels * ratio
      this.size = [width, height]
      this.ratio = ratio
    }
    const scale = camera.scale(width, height)
    this.pointMaterial.uniforms.scale.value = scale
    Object.assign(this.camera, {
      left: -width / 2 / scale, right: width / 2 / scale, top: height / 2 / scale, bottom: -height / 2 / scale,
    })
    this.camera.updateProjectionMatrix()
    const { right, up, back } = camera.axes()
    const [x, y, z] = camera.target
    this.camera.matrix.set(right[0], up[0], back[0], x, right[1], up[1], back[1], y, right[2], up[2], back[2], z, 0, 0, 0, 1)
    this.camera.matrixWorldNeedsUpdate = true
    this.lineMaterial.uniforms.size.value.set(width, height)
    this.renderer.render(this.scene, this.camera)
  }

  // What is nearest to a place of the picture, within some pixels; nodes come before arcs.
  find(camera: Camera, [px, py]: number[], reach = 9): Found {
    const { shape } = this
    if (!shape) return {}
    const [width, height] = this.size
    const scale = camera.scale(width, height)
    const { right, up } = camera.axes()
    const [rx, ry, rz] = right.map((x) => x * scale)
    const [ux, uy, uz] = up.map((x) => -x * scale)
    // Relative to the place.
    const [tx, ty, tz] = camera.target
    const x0 = width / 2 - px - (tx * rx + ty * ry + tz * rz)
    const y0 = height / 2 - py - (tx * ux + ty * uy + tz * uz)
    const xOf = (p: Float32Array, i: number) => x0 + p[i] * rx + p[i + 1] * ry + p[i + 2] * rz
    const yOf = (p: Float32Array, i: number) => y0 + p[i] * ux + p[i + 1] * uy + p[i + 2] * uz
    const { nodes, start, end, life, arc } = shape
    let least = (reach + 3) ** 2
    let found: Found = {}
    for (let i = 0; i < this.kinds.length; ++i) {
      if (this.kinds[i] === 0) continue
      const [x, y] = [xOf(nodes, 3 * i), yOf(nodes, 3 * i)]
      const distance = x * x + y * y
      if (distance < least) [least, found] = [distance, { node: i }]
    }
    if (found.node !== undefined) return found
    least = reach ** 2
    for (let i = 0; i < arc.length; ++i) {
      if (this.version < life[2 * i] || this.version >= life[2 * i + 1]) continue
      const [ax, ay] = [xOf(start, 3 * i), yOf(start, 3 * i)]
      const [dx, dy] = [xOf(end, 3 * i) - ax, yOf(end, 3 * i) - ay]
      const length = dx * dx + dy * dy
      const t = length > 0 ? Math.min(1, Math.max(0, -(ax * dx + ay * dy) / length)) : 0
      const [x, y] = [ax + t * dx, ay + t * dy]
      const distance = x * x + y * y
      if (distance < least) [least, found] = [distance, { arc: arc[i] }]
    }
    return found
  }

  private remove(object: Mesh | Points | null) {
    if (!object) return
    this.scene.remove(object)
    object.geometry.dispose()
  }
}
