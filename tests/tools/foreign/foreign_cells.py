# Cell files that VTK and meshio write, read by the program: foreign_cells.py REEB FOLDER [vtk] [meshio]
#
# Each mesh is written in every encoding. Expected are its vertices, their properties, its components and the number of
# simplices, as they follow from the cells; and the same graph of all encodings.
import json
import os
import struct
import subprocess
import sys

reeb, folder, *libraries = sys.argv[1:]
failures = []
files = 0

# Types of cells by VTK's number: meshio's name, and the number of corners. A tetra10 has six more nodes.
TYPES = {
    1: ('vertex', 1), 3: ('line', 2), 5: ('triangle', 3), 9: ('quad', 4), 10: ('tetra', 4), 12: ('hexahedron', 8),
    13: ('wedge', 6), 14: ('pyramid', 5), 24: ('tetra10', 4),
}
# Faces of a hexahedron, as rings of its corners.
FACES = [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]


class Mesh:
    # A property is a list of tuples.
    def __init__(self, points, cells):
        self.points = points
        self.cells = cells
        n = len(points)
        # Numbers of few bits, which no format rounds.
        self.scalar = [(i * 37 % (n + 1) - n / 2 + 0.125,) for i in range(n)]
        self.vector = [(i * 11 % 7 * 0.5, 2.0 ** (i % 5) - i, -i * i * 0.25) for i in range(n)]
        self.count = [(i * 53 % 97 - 40,) for i in range(n)]

    # What the program is to read: nodes that are no corner of a cell, but inside one, are left out.
    def kept(self):
        corners = {c for kind, nodes in self.cells for c in nodes[:TYPES[kind][1]]}
        inner = {c for kind, nodes in self.cells for c in nodes[TYPES[kind][1]:]}
        return [i for i in range(len(self.points)) if i in corners or i not in inner]

    def components(self):
        part = list(range(len(self.points)))
        for kind, nodes in self.cells:
            for node in nodes[1:TYPES[kind][1]]:
                one, other = part[nodes[0]], part[node]
                part = [one if p == other else p for p in part]
        return len({part[i] for i in self.kept()})

    # By dimension. Faces of cells are divided at their lowest vertex. A hexahedron becomes five tetrahedra if no such
    # diagonal ends at the corner opposite to its lowest vertex, else six.
    def simplices(self):
        counts = [0, 0, 0, 0]
        for kind, nodes in self.cells:
            if kind == 12:
                lowest = min(nodes)
                opposite = nodes[{0: 6, 1: 7, 2: 4, 3: 5, 4: 2, 5: 3, 6: 0, 7: 1}[nodes.index(lowest)]]
                rings = [[nodes[c] for c in face] for face in FACES]
                ends = [r for r in rings if opposite in r
                        and min(r) in (opposite, r[(r.index(opposite) + 2) % 4])]
                counts[3] += 6 if ends else 5
            else:
                dimension, number = {1: (0, 1), 3: (1, 1), 5: (2, 1), 9: (2, 2), 10: (3, 1), 13: (3, 3), 14: (3, 2),
                                     24: (3, 1)}[kind]
                counts[dimension] += number
        return counts


# Cells of every type: a grid of 4 x 3 x 3 points, whose order is mixed, and what is above and beside it.
def mixed(quadratic):
    def corner(i, j, k):
        return (i + 4 * (j + 3 * k)) * 11 % 36

    points = [None] * 36
    for k in range(3):
        for j in range(3):
            for i in range(4):
                points[corner(i, j, k)] = (i + 0.25 * k, j * 1.5, k + 0.125 * i)

    def add(*point):
        points.append(point)
        return len(points) - 1

    def box(i, j, k):
        return [corner(i + a, j + b, k + c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]

    cells = []
    for i in range(3):
        cells += [(12, box(i, j, 0)) for j in range(2)] + [(12, box(i, 0, 1))]
    for i in range(2):
        b = box(i, 1, 1)
        cells += [(13, [b[c] for c in (0, 1, 2, 4, 5, 6)]), (13, [b[c] for c in (0, 2, 3, 4, 6, 7)])]
    top = add(2.75, 2.5, 4.0)
    base = box(2, 1, 1)[:4]
    cells += [(14, base + [top]), (10, [base[2], base[3], corner(3, 2, 2), top])]
    a, b, c, d = add(-1.0, 0.0, 0.5), add(-1.5, 1.0, 0.0), add(-2.0, 0.5, 1.0), add(-2.5, 0.0, -3.0)
    cells += [(5, [a, b, corner(0, 0, 0)]), (9, [a, b, c, d]), (3, [d, top]), (3, [c, corner(0, 2, 2)])]
    if quadratic:
        ten = [a, c, b, add(-1.25, 0.25, 2.0)]
        for p, q in ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)):
            ten.append(add(*((x + y) / 2 for x, y in zip(points[ten[p]], points[ten[q]]))))
        cells.append((24, ten))
    far = add(8.0, 8.0, 8.0)
    add(9.0, 9.0, 9.0)  # of no cell
    cells += [(1, [far]), (1, [top])]
    return Mesh(points, cells)


# The tetrahedra of boxes in a ring, so that the graph has a loop.
def ring():
    around = [(0, 0), (1, 0), (2, 0), (3, 0), (3, 1), (3, 2), (3, 3), (2, 3), (1, 3), (0, 3), (0, 2), (0, 1)]
    points, number, cells = [], {}, []

    def corner(x, y, z):
        if (x, y, z) not in number:
            number[x, y, z] = len(points)
            points.append((x + 0.0625 * y, y - 0.125 * z, z + 0.25 * x + 0.5 * y))
        return number[x, y, z]

    for x, y in around:
        at = [corner(x + (c & 1), y + (c >> 1 & 1), c >> 2) for c in range(8)]
        cells += [(10, [at[0], at[p], at[q], at[7]]) for p, q in ((1, 3), (3, 2), (2, 6), (6, 4), (4, 5), (5, 1))]
    return Mesh(points, cells)


def run(*words):
    done = subprocess.run((reeb,) + words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise RuntimeError('reeb %s: exit code %d\n%s' % (' '.join(words), done.returncode, done.stderr))
    return done.stdout


def expect(what, found, expected):
    if found != expected:
        raise RuntimeError('%s: %s instead of %s' % (what, found, expected))


# Point and properties of each vertex, in the order of the file: their names, and a tuple a vertex.
def vertices_of(name):
    run('convert', name, 'out.ply', '--force', '--quiet')
    with open(os.path.join(folder, 'out.ply'), 'rb') as ply:
        number, names, kinds = 0, [], ''
        for line in iter(ply.readline, b'end_header\n'):
            words = line.decode().split()
            if words[:2] == ['element', 'vertex']:
                number = int(words[2])
            elif words[0] == 'property' and words[1] != 'list':
                names.append(words[2])
                kinds += {'double': 'd', 'float': 'f', 'int': 'i'}[words[1]]
        one = struct.Struct('<' + kinds)
        return names, [one.unpack(ply.read(one.size)) for _ in range(number)]


def graph_of(name, function):
    run('compute', name, '-f', function, '-o', 'out.reeb', '--force', '--quiet')
    return run('extract', 'out.reeb', '-o', '-', '--format', 'rg')


# The graph of the first file of each mesh.
graphs = {}


# `properties` are names and values of those that the file has, and `simplices` what differs from the mesh.
def check(name, mesh, mesh_name, properties, simplices=None):
    global files
    files += 1
    try:
        kept = mesh.kept()
        info = json.loads(run('info', name, '--json'))
        expect('vertices', info['vertices'], len(kept))
        expect('simplices', info['simplices'], (simplices or mesh.simplices()) + [0] * 5)  # up to dimension 8
        if mesh.cells:
            expect('components', info['components']['count'], mesh.components())
        names, columns = ['x', 'y', 'z'], list(zip(*mesh.points))
        for label, values in properties:
            width = len(values[0])
            names += [label] if width == 1 else ['%s:%d' % (label, k) for k in range(width)]
            columns += zip(*values)
        found_names, found = vertices_of(name)
        expect('names', found_names, names)
        expect('vertices written', len(found), len(kept))
        for i, values in zip(kept, found):
            expect('values of point %d' % i, values, tuple(column[i] for column in columns))
        # The same values from a file of this script, for formats without properties.
        with open(os.path.join(folder, 'values.txt'), 'w') as out:
            out.write(''.join('%r\n' % mesh.scalar[i][0] for i in kept))
        graph = graph_of(name, 'property:' + properties[0][0] if properties else 'file:values.txt')
        expect('graph', graph, graphs.setdefault(mesh_name, graph))
    except Exception as error:
        failures.append('%s: %s' % (name, error))


def write_with_vtk():
    from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkFloatArray, vtkIntArray, vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkUnstructuredGrid
    from vtkmodules.vtkIOLegacy import vtkPolyDataWriter, vtkUnstructuredGridWriter
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter

    def array(kind, name, values):
        made = kind()
        made.SetName(name)
        made.SetNumberOfComponents(len(values[0]))
        for value in values:
            made.InsertNextTuple(value)
        return made

    def filled(data, mesh):
        points = vtkPoints()
        points.SetDataTypeToDouble()
        for point in mesh.points:
            points.InsertNextPoint(point)
        data.SetPoints(points)
        data.GetPointData().SetScalars(array(vtkDoubleArray, 'height', mesh.scalar))
        data.GetPointData().SetVectors(array(vtkFloatArray, 'flow', mesh.vector))
        data.GetPointData().AddArray(array(vtkIntArray, 'count', mesh.count))
        # Arrays of cells are not read; they must be skipped.
        data.GetCellData().SetScalars(array(vtkIntArray, 'number', [(i,) for i in range(data.GetNumberOfCells())]))
        return data

    def grid(mesh):
        data = vtkUnstructuredGrid()
        for kind, nodes in mesh.cells:
            data.InsertNextCell(kind, len(nodes), nodes)
        return filled(data, mesh)

    # Points, lines, polygons and strips.
    def surface(mesh, groups):
        data = vtkPolyData()
        for setter, cells in zip((data.SetVerts, data.SetLines, data.SetPolys, data.SetStrips), groups):
            made = vtkCellArray()
            for nodes in cells:
                made.InsertNextCell(len(nodes), nodes)
            setter(made)
        return filled(data, mesh)

    def write(mesh_name, data, mesh, legacy, xml, suffix, simplices=None):
        properties = [('height', mesh.scalar), ('flow', mesh.vector), ('count', mesh.count)]

        def finish(writer, name):
            writer.SetInputData(data)
            writer.SetFileName(os.path.join(folder, name))
            expect('written', writer.Write(), 1)
            check(name, mesh, mesh_name, properties, simplices)

        for version in 42, 51:
            for mode in 'ASCII', 'Binary':
                writer = legacy()
                writer.SetFileVersion(version)
                getattr(writer, 'SetFileTypeTo' + mode)()
                finish(writer, '%s-%d-%s.vtk' % (mesh_name, version, mode))
        for mode in 'Ascii', 'Binary', 'AppendedRaw', 'AppendedBase64':
            for packing in 'None', 'ZLib', 'LZ4':
                for width in 'UInt32', 'UInt64':
                    # Text is neither packed nor has sizes.
                    if mode == 'Ascii' and (packing, width) != ('None', 'UInt32'):
                        continue
                    writer = xml()
                    if mode.startswith('Appended'):
                        writer.SetDataModeToAppended()
                        writer.SetEncodeAppendedData(mode == 'AppendedBase64')
                    else:
                        getattr(writer, 'SetDataModeTo' + mode)()
                    getattr(writer, 'SetCompressorTypeTo' + packing)()
                    getattr(writer, 'SetHeaderTypeTo' + width)()
                    if packing != 'None':
                        writer.SetBlockSize(128)  # several blocks
                    if packing == 'ZLib':
                        writer.SetByteOrderToBigEndian()
                    finish(writer, '%s-%s-%s-%s%s' % (mesh_name, mode, packing, width, suffix))

    for name, mesh in ('mixed', mixed(True)), ('ring', ring()):
        write(name, grid(mesh), mesh, vtkUnstructuredGridWriter, vtkXMLUnstructuredGridWriter, '.vtu')

    # A listed point counts, as does each simplex of a line, of a fan and of a strip.
    mesh = Mesh(mixed(False).points, [])
    groups = ([[3], [5, 7, 8]], [[0, 1], [1, 2, 9, 4]], [[10, 11, 12], [12, 13, 14, 15], [20, 21, 22, 23, 24]],
              [[15, 16, 17, 18, 19], [30, 31, 32]])
    write('surface', surface(mesh, groups), mesh, vtkPolyDataWriter, vtkXMLPolyDataWriter, '.vtp',
          [1 + 3, 1 + 3, 1 + 2 + 3 + 3 + 1, 0])


def write_with_meshio():
    import meshio
    import numpy

    def made(mesh, tagged=False):
        blocks = []
        for kind, nodes in mesh.cells:
            if not blocks or blocks[-1][0] != TYPES[kind][0]:
                blocks.append((TYPES[kind][0], []))
            blocks[-1][1].append(nodes)
        data = {
            'height': numpy.array([v[0] for v in mesh.scalar]),
            'flow': numpy.array(mesh.vector),
        }
        tags = {}
        if tagged:  # without these, meshio writes only one kind of cells
            n = len(mesh.points)
            data['gmsh:dim_tags'] = numpy.array([(2 if i < n / 3 else 3, 1) for i in range(n)])
            tags = {name: [numpy.array([i + 1] * len(block[1])) for i, block in enumerate(blocks)]
                    for name in ('gmsh:physical', 'gmsh:geometrical')}
        return meshio.Mesh(numpy.array(mesh.points), blocks, point_data=data, cell_data=tags)

    def path(name):
        return os.path.join(folder, name)

    for mesh_name, mesh in ('mixed', mixed(True)), ('ring', ring()):
        properties = [('height', mesh.scalar), ('flow', mesh.vector)]
        for binary in False, True:
            end = 'binary' if binary else 'text'
            for version in '2.2', '4.1':
                name = '%s-%s-%s.msh' % (mesh_name, version, end)
                meshio.gmsh.write(path(name), made(mesh, True), fmt_version=version, binary=binary)
                check(name, mesh, mesh_name, properties)
            for version in '4.2', '5.1':
                name = '%s-meshio-%s-%s.vtk' % (mesh_name, version, end)
                meshio.vtk.write(path(name), made(mesh), fmt_version=version, binary=binary)
                check(name, mesh, mesh_name, properties)
            for packing in (None, 'zlib') if binary else (None,):
                for width in 'UInt32', 'UInt64':
                    name = '%s-meshio-%s-%s-%s.vtu' % (mesh_name, end, packing, width)
                    meshio.vtu.write(path(name), made(mesh), binary=binary, compression=packing, header_type=width)
                    check(name, mesh, mesh_name, properties)
    # Medit has no properties, and in meshio no points and no quadratic tetrahedra.
    mesh = mixed(False)
    meshio.vtu.write(path('linear.vtu'), made(mesh))
    check('linear.vtu', mesh, 'linear', [('height', mesh.scalar), ('flow', mesh.vector)])
    for mesh_name, mesh in ('linear', mesh), ('ring', ring()):
        data = made(mesh)
        data.point_data = {}
        meshio.medit.write(path(mesh_name + '.mesh'), data)
        check(mesh_name + '.mesh', mesh, mesh_name, [], [0] + mesh.simplices()[1:])
    # TetGen has tetrahedra only.
    mesh = ring()
    data = made(mesh)
    # The first is written as an integer that marks the boundary, the other as an attribute.
    data.point_data = {'mark:ref': numpy.arange(len(mesh.points)), 'height': data.point_data['height']}
    meshio.tetgen.write(path('ring.ele'), data)
    check('ring.ele', mesh, 'ring', [('attribute:0', mesh.scalar)])


for library in libraries:
    before = files
    {'vtk': write_with_vtk, 'meshio': write_with_meshio}[library]()
    print('%s: %d files' % (library, files - before))
for failure in failures:
    print('failed:', failure)
sys.exit(1 if failures or files == 0 else 0)
