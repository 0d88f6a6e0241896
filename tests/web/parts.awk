# Writes an OBJ file: a path whose 61 vertices are lower and higher in turns, and 150 edges apart from it.
BEGIN {
  for (i = 0; i < 61; ++i) print "v", i, 0, i % 2 ? i : -i
  for (i = 0; i < 300; ++i) print "v", int(i / 2), 5, i % 2
  for (i = 1; i < 61; ++i) print "l", i, i + 1
  for (i = 62; i < 362; i += 2) print "l", i, i + 1
}
