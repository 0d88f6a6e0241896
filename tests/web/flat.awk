# Writes an OFF file: two triangles whose heights differ in the last two bits only.
BEGIN {
  print "OFF\n4 2 0\n0 0 1\n1 0 1.0000000000000002\n0 1 1.0000000000000004\n1 1 1.0000000000000002\n3 0 1 2\n3 1 3 2"
}
