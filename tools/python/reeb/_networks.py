"""Graphs of networkx as meshes of edges."""

import numpy as np

from ._arguments import is_number
from .errors import Error


def is_network(thing):
    return all(hasattr(thing, name) for name in ("nodes", "edges", "adj"))


def parts_of_network(network):
    """(positions or None, edges); vertices are numbered in the order of `network.nodes`."""
    number = {node: i for i, node in enumerate(network.nodes)}
    edges = np.array([(number[a], number[b]) for a, b in network.edges()], np.int64).reshape(-1, 2)
    ends = np.sort(edges, axis=1)
    if len(np.unique(ends, axis=0)) != len(ends) or (ends[:, 0] == ends[:, 1]).any():
        raise Error(
            "the network has parallel edges or edges from a node to itself, which meshes do not have",
            "put a node on each of them; of a directed network use network.to_undirected()",
        )
    return _positions(network), edges


def _positions(network):
    columns = values_of_network(network, ("x", "y", "z"))
    if len(columns) == 3:
        return np.stack([columns[axis].astype(float) for axis in "xyz"], axis=1)
    places = [place for _, place in network.nodes(data="pos")]
    return None if not places or any(place is None for place in places) else places


def values_of_network(network, names=None):
    """The attributes that each node has as a number, as arrays by name. Integers stay integers, since a double does not
    hold all of them."""
    rows = [attributes for _, attributes in network.nodes(data=True)]
    if names is None:
        names = list(rows[0]) if rows else []
    columns = {}
    for name in names:
        given = [row.get(name) for row in rows]
        if not given or not all(is_number(value) for value in given):
            continue
        values = np.array(given)
        columns[str(name)] = values if values.dtype.kind in "iuf" else values.astype(float)
    return columns
