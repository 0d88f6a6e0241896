// Which marks of nodes are small, so that they do not cover the lines: where there are more than a few nodes, those
// whose arcs are short in the picture, as in `reeb plot` (io/plot/skeleton_picture.cpp).

export const kFewNodes = 20
export const kSmallMark = 0.4 // of the size of others

const kShort = 8 // pixels
const kLoneShort = 40 // of an arc that is a component, of which there are often many

// The room of a node is the largest one of its arcs, and 0 without arcs. `length`: of the arc, in the scene.
export const roomOf = (length, isLone) => length / (isLone ? kLoneShort : kShort)

// `scale`: pixels for one unit of the scene.
export const isSmall = (room, scale) => room * scale < 1
