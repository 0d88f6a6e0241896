// Prints the number of pairs of crossing triangles in each OFF file, as CGAL counts them. Only a tool of a test: CGAL's
// licence does not allow it in the program.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <cstdio>
#include <iterator>
#include <utility>
#include <vector>

int main(int argc, char** argv) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  namespace processing = CGAL::Polygon_mesh_processing;
  for (int i = 1; i < argc; ++i) {
    std::vector<Kernel::Point_3> points;
    std::vector<std::vector<std::size_t>> triangles;
    if (!CGAL::IO::read_polygon_soup(argv[i], points, triangles) ||
        !processing::is_polygon_soup_a_polygon_mesh(triangles))
      return 1;
    Mesh mesh;
    processing::polygon_soup_to_polygon_mesh(points, triangles, mesh);
    std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
    processing::self_intersections<CGAL::Sequential_tag>(faces(mesh), mesh, std::back_inserter(pairs));
    std::printf("%zu\n", pairs.size());
  }
  return 0;
}
