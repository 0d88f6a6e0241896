from os import PathLike
from typing import Any, Callable, ClassVar, Literal, Mapping, NamedTuple, Sequence, TypedDict, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Unpack

from .errors import Error as Error
from .pictures import Picture

__version__: str

_Path = str | PathLike[str]
_Progress = bool | None | Callable[[str, int, int, int], object]
_Values = ArrayLike | Mapping[str, ArrayLike]

class _Options(TypedDict, total=False):
    memory: int | str | None
    denoise: float | str | None
    threads: int | None
    graph_only: bool
    buckets: int
    format: str | None
    spacing: Sequence[float] | str | None
    origin: Sequence[float] | None
    nodata: float | Literal["skip"] | None
    grid: Sequence[int] | str | None
    type: str | None
    skip: int | None
    reorder: bool
    manifold: bool
    sidecar: bool
    snapshot_every: int | None
    chunk: int | None
    temp_dir: _Path | None
    resume: bool
    force: bool
    progress: _Progress

class Skeleton(NamedTuple):
    points: NDArray[np.float64]
    edges: NDArray[np.int64]
    radius: NDArray[np.float64]
    arc: NDArray[np.int64]

class _Segmentation(NamedTuple):
    labels: NDArray[np.int64]
    values: NDArray[np.float64]

class Segmentation(_Segmentation):
    DROPPED: ClassVar[int]

class Defects(NamedTuple):
    loops: NDArray[np.void]
    suggested_threshold: dict[str, Any]
    others: dict[str, dict[str, Any]]

class Graph:
    function: str
    result: dict[str, Any]
    @property
    def nodes(self) -> NDArray[np.void]: ...
    @property
    def arcs(self) -> NDArray[np.int64]: ...
    @property
    def pairs(self) -> NDArray[np.void]: ...
    def loops(self) -> NDArray[np.void]: ...
    @property
    def components(self) -> int: ...
    @property
    def loop_count(self) -> int: ...
    @property
    def header(self) -> dict[str, Any]: ...
    @property
    def range(self) -> tuple[float, float]: ...
    @property
    def path(self) -> str | None: ...
    @property
    def threshold(self) -> float: ...
    @property
    def levels(self) -> NDArray[np.void]: ...
    def save(self, path: _Path, *, force: bool = ...) -> None: ...
    def level(
        self, threshold: float | str | None = ..., *, nodes: int | None = ..., memory: int | str | None = ...
    ) -> Graph: ...
    def refine(
        self, threshold: float | str | None = ..., *, nodes: int | None = ..., memory: int | str | None = ...
    ) -> Graph: ...
    def coarsen(
        self, threshold: float | str | None = ..., *, nodes: int | None = ..., memory: int | str | None = ...
    ) -> Graph: ...
    def skeleton(self) -> Skeleton: ...
    def to_networkx(self) -> Any: ...
    def to_polydata(self) -> Any: ...
    def to_gudhi(self) -> list[list[tuple[int, tuple[float, float]]]]: ...
    def to_persim(self) -> list[NDArray[np.float64]]: ...
    def plot(
        self,
        output: _Path | None = ...,
        *,
        kind: Literal["graph", "skeleton", "diagram", "loops"] = ...,
        mesh: _Path | None = ...,
        view: tuple[float, float, float] | None = ...,
        force: bool = ...,
    ) -> Picture: ...

class Online:
    def __init__(self) -> None: ...
    def add_vertices(self, values: ArrayLike, positions: ArrayLike | None = ...) -> NDArray[np.int64]: ...
    def add_simplices(self, simplices: ArrayLike) -> None: ...
    def finalize(self, ids: ArrayLike) -> None: ...
    def snapshot(self) -> Graph: ...
    @property
    def memory_bytes(self) -> int: ...

def open(
    path: _Path,
    *,
    threshold: float | str | None = ...,
    nodes: int | None = ...,
    memory: int | str | None = ...,
    listener: Any = ...,
) -> Graph: ...
@overload
def compute(
    mesh: Any,
    faces: Any = ...,
    values: _Values | None = ...,
    f: str | None = ...,
    *,
    output: _Path | None = ...,
    **options: Unpack[_Options],
) -> Graph: ...
@overload
def compute(
    mesh: Any,
    faces: Any = ...,
    values: _Values | None = ...,
    *,
    f: list[str] | tuple[str, ...],
    output: Sequence[_Path] | None = ...,
    **options: Unpack[_Options],
) -> list[Graph]: ...
@overload
def compute(
    mesh: Any,
    faces: Any = ...,
    values: _Values | None = ...,
    f: NDArray[Any] | list[float] = ...,
    *,
    output: _Path | None = ...,
    **options: Unpack[_Options],
) -> Graph: ...
def segment(
    graph: Graph,
    mesh: Any,
    faces: Any = ...,
    values: _Values | None = ...,
    *,
    memory: int | str | None = ...,
    threads: int | None = ...,
    format: str | None = ...,
    spacing: Sequence[float] | str | None = ...,
    origin: Sequence[float] | None = ...,
    nodata: float | Literal["skip"] | None = ...,
    grid: Sequence[int] | str | None = ...,
    type: str | None = ...,
    skip: int | None = ...,
    temp_dir: _Path | None = ...,
    progress: _Progress = ...,
) -> Segmentation: ...
def defects(
    mesh: Any,
    faces: Any = ...,
    *,
    graphs: _Path | Sequence[_Path] | None = ...,
    memory: int | str | None = ...,
    threads: int | None = ...,
    format: str | None = ...,
    temp_dir: _Path | None = ...,
    progress: _Progress = ...,
) -> Defects: ...
