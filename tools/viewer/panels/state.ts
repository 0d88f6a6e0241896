// What the page shows: one object, which its parts are given. What belongs to a file ends with it: another file begins
// with a new OpenFile.
import type { Camera } from '../../web/camera.js'
import { thresholdText } from '../../web/data.js'
import type { Backdrop } from '../drawing/backdrop'
import type { Picture } from '../drawing/picture'
import type { Frame } from '../drawing/shapes'
import type { Header } from '../reading/header'
import type { VersionContent } from '../reading/loaded_graph'
import type { Session } from '../reading/session'
import type { Source } from '../reading/source'

export const kDefaultBudget = 200_000

export interface View {
  place: HTMLElement
  picture: Picture
  camera: Camera
}

// A feature: one node, an arc, or a pair.
export interface Choice {
  arc: number
  nodes: number[]
  text: string
}

// A pair in the diagram.
export interface Mark {
  drawn: [type: string, low: number, high: number, lowVertex: number, highVertex: number]
  lo: number // nodes
  hi: number
}

export class OpenFile {
  shapeRecords = 0 // of the pictures, also while they are being made
  drawnRecords = 0 // of the pictures that are there
  shapeBytes = { space: 0, flat: 0 }
  marks: Mark[] = []
  choice: Choice | null = null
  backdrop: Backdrop | null = null
  wantedBackdrop: File | null = null
  // The reading of pairs, and how many nodes there were when it began.
  pairs: { nodes: number; shown: Promise<void> } | null = null
  layoutTimer = 0
  stopShapes = () => {}

  // `content`: the version that is shown. `frame`: of the skeleton.
  constructor(readonly session: Session, public content: VersionContent, readonly frame: Frame) {}

  get reader() {
    return this.session.reader
  }

  get graph() {
    return this.session.reader.graph
  }

  get header() {
    return this.session.reader.header
  }

  close() {
    this.session.close()
    this.stopShapes()
    clearTimeout(this.layoutTimer)
  }
}

export interface Viewer {
  source: Source | null // of the file that is open or is being opened
  file: OpenFile | null // from its first version on
  space: View | null // without WebGL there are no views
  flat: View | null
  // Numbers of timers and frames that wait.
  saving: number
  drawing: number
  hash: string // of the address, as it was last read or written
}

export const makeViewer = (): Viewer => ({
  source: null, file: null, space: null, flat: null, saving: 0, drawing: 0, hash: location.hash,
})

export const viewsOf = ({ space, flat }: Viewer) => [space, flat].filter((view) => view !== null)

export const rangeOf = ({ min, max }: Header) => max - min

function nextUp(value: number): number {
  const next = new Float64Array([value])
  new BigInt64Array(next.buffer)[0] += 1n
  return next[0]
}

// The least threshold at which a version is shown.
export function thresholdOf({ header, graph }: OpenFile, version: number): number {
  const line = header.levels.find((level) => level.version === version)
  if (line) return line.threshold
  return version === 0 ? 0 : nextUp(graph.persistenceOf(version))
}

// A threshold as a number that yields the same version, of those that were read.
export function levelText({ graph }: OpenFile, threshold: number): string {
  const version = graph.versionAt(threshold)
  return thresholdText(threshold, (number) => graph.versionAt(number) === version)
}
