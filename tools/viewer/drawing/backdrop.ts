// A mesh behind the skeleton: a PLY file, small enough to be read whole.
import { BufferAttribute, BufferGeometry } from 'three'
import { PLYLoader } from 'three/examples/jsm/loaders/PLYLoader.js'
import { boxOf } from './shapes'
import type { Box } from './shapes'

const kMostMegabytes = 64
const kTolerance = 0.05 // of the size

// Triangles at the positions that the file has.
export interface Backdrop {
  name: string
  corners: Float32Array // x, y, z of each vertex
  triangles: Uint32Array
}

export const backdropBytes = ({ corners, triangles }: Backdrop) => corners.byteLength + triangles.byteLength

// THROWS an Error that says what is wrong, if it is not such a file.
export async function readBackdrop(file: File): Promise<Backdrop> {
  if (file.size > kMostMegabytes * 2 ** 20)
    throw new Error(`${file.name} is larger than ${kMostMegabytes} MiB. Reduce it to fewer triangles first, with a program like MeshLab.`)
  const bytes = await file.arrayBuffer()
  const wrong = (what: string) => new Error(`${file.name} cannot be shown behind the skeleton: ${what}.`)
  if (new TextDecoder().decode(bytes.slice(0, 3)) !== 'ply') throw wrong('it is not a PLY file')
  let read: BufferGeometry
  try {
    read = new PLYLoader().parse(bytes)
  } catch {
    throw wrong('it is damaged')
  }
  const [position, index] = [read.getAttribute('position'), read.getIndex()]
  if (!position || !index || index.count === 0) throw wrong('it has no triangles')
  const corners = Float32Array.from(position.array)
  const triangles = Uint32Array.from(index.array)
  if (!corners.every(Number.isFinite)) throw wrong('a coordinate is not finite')
  if (!triangles.every((vertex) => vertex < position.count)) throw wrong('a triangle names a vertex that is not there')
  return { name: file.name, corners, triangles }
}

// Whether the mesh can be that of a skeleton, whose nodes are at its vertices: then its box contains theirs, but for what
// vertices move when a mesh is reduced. `height`: the axis of a height function, or -1; its range is that of the mesh.
export function fits({ corners }: Backdrop, box: Box, height: number, { min, max }: { min: number; max: number }): boolean {
  const mesh = boxOf([corners])
  const spare = kTolerance * Math.hypot(...box.most.map((x, k) => x - box.least[k]))
  const contains = [0, 1, 2].every((k) => box.least[k] >= mesh.least[k] - spare && box.most[k] <= mesh.most[k] + spare)
  if (height < 0) return contains
  const spareHeight = kTolerance * (max - min)
  return contains && mesh.least[height] >= min - spareHeight && mesh.most[height] <= max + spareHeight
}

// In the cube in which the skeleton is drawn.
export function placed({ corners, triangles }: Backdrop, middle: number[], scale: number): BufferGeometry {
  const geometry = new BufferGeometry()
  geometry.setAttribute('position', new BufferAttribute(corners.map((x, i) => (x - middle[i % 3]) * scale), 3))
  geometry.setIndex(new BufferAttribute(triangles, 1))
  return geometry
}
