// A camera that looks at the x-y plane: dragging moves instead of rotating.
import { Camera } from '../../web/camera.js'

export class FlatCamera extends Camera {
  side = 1 // pixels of the smaller side of the picture

  constructor() {
    super(1)
  }

  reset() {
    super.reset(2)
  }

  rotate(turn: number, tilt: number) {
    this.move((-turn * 150) / (this.side ?? 1), (-tilt * 150) / (this.side ?? 1))
  }
}
