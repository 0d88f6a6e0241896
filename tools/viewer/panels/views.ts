// The two pictures, with their cameras: the skeleton in space, and the graph by value with its axis.
import { Camera, control } from '../../web/camera.js'
import { shortNumber } from '../../web/data.js'
import { niceTicks } from '../../web/plots.js'
import { FlatCamera } from '../drawing/flat_camera'
import { Picture } from '../drawing/picture'
import type { Header } from '../reading/header'
import { saveState } from './address'
import { element } from './page'
import { viewsOf } from './state'
import type { OpenFile, View, Viewer } from './state'

const kClickPixels = 5 // that a pointer moves at most between down and up
const drawn = element('drawn')

export interface Handlers {
  hovered(view: View, at: number[] | null): void
  clicked(view: View, at: number[]): void
}

// THROWS if there is no WebGL.
export function makeViews(viewer: Viewer, handlers: Handlers) {
  const made = [makeView(viewer, 'space', new Camera(), handlers), makeView(viewer, 'flat', new FlatCamera(), handlers)]
  ;[viewer.space, viewer.flat] = made
}

function makeView(viewer: Viewer, id: string, camera: Camera, { hovered, clicked }: Handlers): View {
  const place = element(id)
  const view = { place, picture: new Picture(place, () => redraw(viewer)), camera }
  control(place, camera, {
    changed: () => redraw(viewer),
    hovered: (at: number[] | null) => hovered(view, at),
    reset: () => fit(viewer),
  })
  let down: number[] | null = null // null while more fingers are down than one
  place.addEventListener('pointerdown', (event) => (down = event.isPrimary ? [event.clientX, event.clientY] : null))
  place.addEventListener('pointerup', (event) => {
    if (!down || event.button !== 0) return
    if (Math.hypot(event.clientX - down[0], event.clientY - down[1]) >= kClickPixels) return
    const corner = place.getBoundingClientRect()
    clicked(view, [event.clientX - corner.left, event.clientY - corner.top])
  })
  new ResizeObserver(() => redraw(viewer)).observe(place)
  return view
}

// A file without positions has no skeleton, and a browser without WebGL no pictures.
export function showPlaces({ space }: Viewer, { name, positions }: Header) {
  element('pictures').hidden = space === null
  for (const control of [element('coloring').parentElement!, element('view-buttons')]) control.hidden = space === null
  element('backdrop').parentElement!.hidden = space === null || !positions
  element('space').parentElement!.hidden = !positions
  space?.camera.setUp(['x', 'y', 'z'].includes(name) ? ['x', 'y', 'z'].indexOf(name) : 2)
}

const sizeOf = ({ place }: View) => [Math.max(1, place.clientWidth), Math.max(1, place.clientHeight)] as const

// All of the graph, from the side or along an axis.
export function fit(viewer: Viewer, axis?: number) {
  const { space, flat, file } = viewer
  if (!space || !flat || !file) return
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [i & 1, (i >> 1) & 1, i >> 2].map((b) => 2 * b - 1))
  space.camera.reset(axis)
  space.camera.fit(nodePlaces(file), ...sizeOf(space))
  flat.camera.reset()
  flat.camera.fit(corners.slice(0, 4), ...sizeOf(flat))
  redraw(viewer)
}

function* nodePlaces({ graph, frame }: OpenFile) {
  const step = Math.max(1, Math.floor(graph.nodes / 5000))
  for (let i = 0; i < graph.nodes && graph.position.length > 0; i += step)
    yield [0, 1, 2].map((k) => (graph.position[3 * i + k] - frame.middle[k]) * frame.scale)
}

export function redraw(viewer: Viewer) {
  if (viewer.drawing) return
  viewer.drawing = requestAnimationFrame(() => {
    viewer.drawing = 0
    const begin = performance.now()
    for (const view of viewsOf(viewer)) {
      const { picture, camera } = view
      const [width, height] = sizeOf(view)
      if (camera instanceof FlatCamera) camera.side = Math.min(width, height)
      picture.draw(camera, width, height)
      if (camera instanceof FlatCamera && viewer.file) showAxis(viewer.file.header, camera, width, height)
    }
    drawn.dataset.frame = (performance.now() - begin).toFixed(2)
    saveState(viewer)
  })
}

// The values at the left edge of the graph.
function showAxis({ min, max }: Header, camera: Camera, width: number, height: number) {
  const project = camera.projector(width, height)
  const ticks = max > min ? niceTicks(min, max) : [{ at: 0.5, text: shortNumber(min) }]
  const labels = ticks.flatMap(({ at, text }) => {
    const y = project([-1, 2 * at - 1, 0])[1]
    if (y < 8 || y > height - 8) return []
    const label = document.createElement('span')
    label.style.top = `${y}px`
    label.textContent = text
    return [label]
  })
  element('axis').replaceChildren(...labels)
}

// After the next frame is drawn; a page that is hidden draws none.
export const nextPicture = () =>
  new Promise<void>((done) => {
    requestAnimationFrame(() => done())
    setTimeout(done, 200)
  })

export function savePictures(viewer: Viewer) {
  for (const { place, picture } of viewsOf(viewer)) {
    if (place.clientWidth === 0) continue // there is no skeleton
    const link = document.createElement('a')
    link.download = `${element('name').textContent}.${place.id}.png`
    link.href = picture.element.toDataURL('image/png')
    link.click()
  }
}
