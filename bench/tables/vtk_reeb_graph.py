"""The Reeb graph of a PLY mesh for a coordinate, by VTK: writes its arcs as pairs of vertices, sorted.

    vtk_reeb_graph.py MESH.ply COORDINATE OUT
    vtk_reeb_graph.py --version

The times of reading and of computing go to standard output."""
import sys
import time

import vtk
from vtk.util import numpy_support

if sys.argv[1] == "--version":
    print(vtk.vtkVersion.GetVTKVersion())
    sys.exit(0)

begin = time.perf_counter()
reader = vtk.vtkPLYReader()
reader.SetFileName(sys.argv[1])
reader.Update()
mesh = reader.GetOutput()
points = numpy_support.vtk_to_numpy(mesh.GetPoints().GetData())
values = numpy_support.numpy_to_vtk(points[:, "xyz".index(sys.argv[2])].copy(), deep=True)
values.SetName("f")
mesh.GetPointData().SetScalars(values)
loaded = time.perf_counter()
graph = vtk.vtkReebGraph()
code = graph.Build(mesh, "f")
done = time.perf_counter()
if code != 0:
    print(f"error: vtkReebGraph returned {code}")
    sys.exit(1)
vertex_of = graph.GetVertexData().GetAbstractArray("Vertex Ids")
arcs = []
edges = vtk.vtkEdgeListIterator()
graph.GetEdges(edges)
while edges.HasNext():
    edge = edges.NextGraphEdge()
    arcs.append((int(vertex_of.GetTuple1(edge.GetSource())), int(vertex_of.GetTuple1(edge.GetTarget()))))
with open(sys.argv[3], "w", encoding="ascii") as out:
    for low, high in sorted(arcs):
        out.write(f"{low} {high}\n")
print(f"load {loaded - begin:.6f}\ncompute {done - loaded:.6f}")
