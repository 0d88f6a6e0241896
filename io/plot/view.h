// The direction from which a shape is seen, and where its points are in a picture.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "io/drawing/svg_text.h"
#include "libreeb/graph/settled_node.h"

namespace reeb::io {

// Orthonormal; `toward` leads to the eye, `up` is up in the picture.
struct View {
  Point right, up, toward;
};

// Seen from this direction, upright as far as possible. REQUIRES: neither is zero.
View view_from(const Point& direction, const Point& upright);

// The views of which best_view() takes one: around `upright`, level and from above, and along the axes.
std::vector<View> views_around(const Point& upright);

// Of several views around `upright`, level and from above, that in which most of the picture is used: by these points
// of a surface (which may be missing) and of lines. TIME: O(points).
View best_view(std::span<const Point> surface, std::span<const Point> lines, const Point& upright);

// A parallel projection into a picture.
class Projection {
 public:
  // `points` fill a box of this width and at most this height, whose upper left corner is `corner`.
  Projection(const View& view, std::span<const Point> points, PicturePoint corner, double width, double most_height);

  PicturePoint place(const Point& point) const;
  // Towards the eye, in pixels.
  double depth(const Point& point) const;
  double height() const { return height_; }  // of the box
  // 0 if all points are one.
  double pixels_per_unit() const { return has_extent_ ? scale_ * unit_ : 0; }

 private:
  View view_;
  PicturePoint corner_;
  double unit_;  // by which points are multiplied first
  double scale_ = 1, left_ = 0, top_ = 0, height_ = 0;
  bool has_extent_ = false;
};

// Components have this form in messages: "0.87,-0.48,0.17".
std::string direction_text(const Point& direction);

}  // namespace reeb::io
