# %% [markdown]
# # Tutorial
#
# Reeb graphs in Python, from arrays to a clean skeleton. [PYTHON.md](PYTHON.md) has all calls.

# %%
import numpy as np

import reeb

# %% [markdown]
# A torus that stands on its side, with some noise, as a scanner would see it:

# %%
n, m = 120, 60
u, w = np.meshgrid(np.arange(n) * 2 * np.pi / n, np.arange(m) * 2 * np.pi / m, indexing="ij")
ring = 2 + 0.7 * np.cos(w)
vertices = np.stack([ring * np.cos(u), 0.7 * np.sin(w), ring * np.sin(u)], -1).reshape(-1, 3)
vertices += np.random.default_rng(1).normal(0, 0.04, vertices.shape)
a = np.arange(n * m).reshape(n, m)
b, d = np.roll(a, -1, 0), np.roll(a, -1, 1)
c = np.roll(b, -1, 1)
faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
vertices.shape, faces.shape

# %% [markdown]
# The Reeb graph of the height, z. Nothing is copied, and nothing is left on disk:

# %%
graph = reeb.compute(vertices, faces)
graph

# %% [markdown]
# Most of these nodes are noise: pairs of a minimum or maximum and a fork, which lie close to each other in height. The
# persistence of a pair is that distance. The five largest:

# %%
pairs = graph.pairs
for type_, lo, hi, persistence in pairs[["type", "lo", "hi", "persistence"]][:5]:
    print(f"{type_}  from vertex {lo} to {hi}  {persistence:.3f}")

# %% [markdown]
# There is one loop, the hole of the torus, and it is much larger than the noise. A level of the graph has only the
# features above a threshold, here ten per cent of the range of heights. It is named by the least threshold that yields
# the same level:

# %%
level = graph.level("10%")
print(level)
print(level.arcs)

# %% [markdown]
# The graph laid out by height:

# %%
level.plot()

# %% [markdown]
# Each arc runs through the middle of its part of the surface. `skeleton()` has these lines as arrays, and how far the
# surface is from them:

# %%
points, edges, radius, arc = level.skeleton()
print(points.shape, edges.shape, f"median radius {np.nanmedian(radius):.2f}")

# %%
level.plot(kind="skeleton", view=(0.3, 1, 0.2))

# %% [markdown]
# Which vertex lies on which arc:

# %%
labels = reeb.segment(level, vertices, faces).labels
for i, (lo, hi) in enumerate(level.arcs):
    print(f"arc {i} from node {lo} to {hi}: {np.count_nonzero(labels == i)} vertices")

# %% [markdown]
# A mesh in a file need not fit into memory: `reeb.compute("scan.ply", memory="64M", output="scan.reeb")` reads it as a
# stream, and `reeb.open("scan.reeb", nodes=1000)` loads no more of the result than that level needs.
#
# Volumes are arrays, too. The value of this one falls with the distance from two points, so there are two maxima:

# %%
z, y, x = np.mgrid[-1:1:40j, -1:1:40j, -2:2:80j]
volume = np.exp(-8 * ((x - 1) ** 2 + y**2 + z**2)) + np.exp(-8 * ((x + 1) ** 2 + y**2 + z**2))
blobs = reeb.compute(volume.astype("f4"), spacing=(0.05, 0.05, 0.05), denoise="1%")
print(blobs)
for value, down, up in blobs.nodes[["value", "down", "up"]]:
    print(f"{value:.3f}: {down} down, {up} up")
