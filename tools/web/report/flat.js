// The skeleton as SVG: for the printer, and where there is no WebGL.
import { css, kindColors, rgb, valueColors } from '../colors.js'
import { isSmall, kSmallMark } from '../marks.js'

const kShapes = { min: 'M-5-4H5L0 5Z', max: 'M-5 4H5L0-5Z', isolated: 'M-4-4H4V4H-4Z', saddle: 'M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0Z' }

export class SvgPicture {
  constructor(place, skeleton) {
    this.skeleton = skeleton
    this.element = document.createElementNS('http://www.w3.org/2000/svg', 'svg')
    this.element.setAttribute('aria-hidden', 'true')
    this.chosen = []
    this.recolor()
    place.append(this.element)
  }

  recolor() {
    this.color = valueColors()
    this.kinds = kindColors()
  }

  show(content) {
    this.content = content
  }

  choose(places) {
    this.chosen = places
  }

  draw(camera, width, height) {
    const project = camera.projector(width, height)
    const scale = camera.scale(width, height)
    const number = (x) => x.toFixed(1)
    // Neighbours of nearly equal colour are one path, and what is far is drawn first.
    const paths = []
    for (const arc of this.content.arcs) {
      const line = this.skeleton.line(arc).map(({ at, value, width }) => ({ at: project(at), value, width }))
      for (let i = 0; i + 1 < line.length; ) {
        let text = `M${number(line[i].at[0])} ${number(line[i].at[1])}`
        const begin = i
        do {
          ++i
          text += `L${number(line[i].at[0])} ${number(line[i].at[1])}`
        } while (
          i + 1 < line.length && Math.abs(line[i].value - line[begin].value) < 0.04 && Math.abs(line[i].width - line[begin].width) < 0.5
        )
        const value = (line[begin].value + line[i].value) / 2
        const wide = (line[begin].width + line[i].width) / 2
        paths.push({ depth: (line[begin].at[2] + line[i].at[2]) / 2, text, color: rgb(this.color(value)), wide })
      }
    }
    paths.sort((a, b) => a.depth - b.depth)
    const lines = paths.map(({ text, color, wide }) => `<path d="${text}" stroke="${color}" stroke-width="${number(wide)}"/>`)
    const marks = this.content.nodes.map((node, i) => {
      const [x, y] = project(this.skeleton.place(node))
      const kind = this.content.kinds[i]
      return `<path d="${kShapes[kind]}" fill="${rgb(this.kinds[kind])}" stroke="${css('--rim')}" transform="translate(${number(x)} ${number(y)})${isSmall(this.content.rooms[i], scale) ? ` scale(${kSmallMark})` : ''}"/>`
    })
    const rings = this.chosen.map((place) => {
      const [x, y] = project(place)
      return `<circle cx="${number(x)}" cy="${number(y)}" r="11" fill="none" stroke="${rgb(this.kinds.max)}" stroke-width="3"/>`
    })
    this.element.setAttribute('viewBox', `0 0 ${width} ${height}`)
    this.element.innerHTML = `<g fill="none" stroke-linecap="round">${lines.join('')}</g>${marks.join('')}${rings.join('')}`
  }
}
