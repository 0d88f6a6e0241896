"""Opens .reeb files in ParaView, with a slider for the threshold, and in VTK programs.

ParaView: Tools, Manage Plugins, Load New, this file. It needs the Python package reeb, for the Python of ParaView.
The ParaView of Debian 12 loads no plugin in Python before its Python shell, or script, was told:
    import inspect; inspect.getargspec = inspect.getfullargspec
VTK: ReebReader() has SetFileName(name), SetThreshold(per cent), Update(), GetOutputDataObject(0).
"""

import reeb

try:
    from paraview.util.vtkAlgorithm import VTKPythonAlgorithmBase, smdomain, smhint, smproperty, smproxy
except ImportError:  # VTK without ParaView
    from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase

    class _Nothing:
        """Decorators of ParaView that do nothing."""

        def __getattr__(self, _):
            return lambda *_, **__: lambda thing: thing

    smproxy = smproperty = smdomain = smhint = _Nothing()


@smproxy.reader(
    name="ReebReader", label="Reeb graph", extensions="reeb", file_description="Reeb graphs with all levels of detail"
)
class ReebReader(VTKPythonAlgorithmBase):
    """A level of a Reeb graph as lines: point data Value and VertexId, cell data SegmentationId."""

    def __init__(self):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkPolyData")
        self._name, self._threshold, self._graph = "", 0.0, None

    @smproperty.stringvector(name="FileName")
    @smdomain.filelist()
    @smhint.filechooser(extensions="reeb", file_description="Reeb graphs")
    def SetFileName(self, name):
        if name != self._name:
            self._name, self._graph = name, None
            self.Modified()

    @smproperty.doublevector(name="Threshold", label="Threshold (%)", default_values=0.0)
    @smdomain.doublerange(min=0, max=100)
    def SetThreshold(self, percent):
        if percent != self._threshold:
            self._threshold = percent
            self.Modified()

    def RequestData(self, request, inputs, outputs):
        from vtkmodules.vtkCommonDataModel import vtkPolyData

        if self._graph is None:
            self._graph = reeb.open(self._name)
        level = self._graph.level(f"{self._threshold}%") if self._threshold > 0 else self._graph
        vtkPolyData.GetData(outputs, 0).ShallowCopy(level.to_polydata())
        return 1
