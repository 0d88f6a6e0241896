"""The Reeb graph by its definition, slowly: contours at and between the values of vertices, in their total order."""


class _Classes:
    def __init__(self, items):
        self._parent = {item: item for item in items}

    def find(self, item):
        while self._parent[item] != item:
            item = self._parent[item]
        return item

    def join(self, a, b):
        self._parent[self.find(a)] = self.find(b)

    def roots(self):
        return {self.find(item) for item in self._parent}


def _faces_of(simplices, size):
    from itertools import combinations

    return {face for simplex in simplices for face in combinations(sorted(set(simplex)), size)}


def reeb_graph(values, simplices):
    """(nodes, arcs): sorted vertices with (down, up), and sorted pairs of vertices; parallel arcs repeat."""
    order = sorted(range(len(values)), key=lambda v: (values[v], v))
    rank = {v: i for i, v in enumerate(order)}
    ranked = [[rank[v] for v in simplex] for simplex in simplices]
    edges, triangles = _faces_of(ranked, 2), _faces_of(ranked, 3)

    def between(i):  # contours just above vertex i
        classes = _Classes(edge for edge in edges if edge[0] <= i < edge[1])
        for low, middle, high in triangles:
            if low <= i < high:
                classes.join((low, high), (low, middle) if i < middle else (middle, high))
        return classes

    def at(i):  # contours at vertex i, which is one item of them
        classes = _Classes([i, *(edge for edge in edges if edge[0] < i < edge[1])])
        for low, middle, high in triangles:
            if low < i < high:
                other = i if i == middle else (low, middle) if i < middle else (middle, high)
                classes.join((low, high), other)
        return classes

    # An arc that is being followed: from the contour in which it is now to the vertex where it began.
    begun, down, ended = {}, {}, []
    for i in range(len(values)):
        level, above = at(i), between(i)
        place = {}
        for contour, start in begun.items():
            edge = contour
            here = level.find(i if edge[1] == i else edge)
            place.setdefault(here, []).append(start)
        mine = level.find(i)
        ups = {}
        for root in above.roots():
            ups.setdefault(level.find(i if root[0] == i else root), []).append(root)
        begun = {}
        for here in set(place) | set(ups) | {mine}:
            below, up = place.get(here, []), ups.get(here, [])
            if here != mine or (len(below) == 1 and len(up) == 1):
                assert len(below) == len(up) == 1
                begun[up[0]] = below[0]
                continue
            down[i] = (len(below), len(up))
            ended += [(start, i) for start in below]
            for root in up:
                begun[root] = i
        # The contour of an arc is named by an edge that is still there.
        begun = {root: start for root, start in begun.items()}
    nodes = [(order[i], *down[i]) for i in sorted(down)]
    arcs = [(order[a], order[b]) for a, b in sorted(ended)]
    return nodes, arcs
