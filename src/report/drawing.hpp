// SVG: marks with a style (a class of style.css, so that they follow the page's light and dark) in a view box
// that scales with the page.
#pragma once

#include <string>
#include <vector>

namespace polar::report {

/// The `d` of a path. Coordinates have a tenth of a unit.
class Path {
 public:
  Path& move(double x, double y);
  Path& line(double x, double y);
  Path& close();
  /// A dot: a line of no length, which round caps make visible.
  Path& dot(double x, double y);
  Path& circle(double x, double y, double radius);
  const std::string& d() const { return d_; }
  bool empty() const { return d_.empty(); }

 private:
  std::string d_;
};

enum class Anchor { start, middle, end };

class Drawing {
 public:
  Drawing(double width, double height) : width_(width), height_(height) {}

  /// `tip` is shown where the mouse rests.
  void path(const std::string& style, const Path& path, const std::string& tip = {});
  void rect(const std::string& style, double x, double y, double width, double height,
            const std::string& tip = {});
  void text(const std::string& style, double x, double y, const std::string& text,
            Anchor anchor = Anchor::start);
  void image(double x, double y, double width, double height, const std::string& uri);

  /// The element; `label` is what a screen reader says.
  std::string svg(const std::string& label) const;

 private:
  struct Mark {
    enum class Kind { path, rect, text, image } kind;
    std::string style, content, tip;
    double x = 0, y = 0, width = 0, height = 0;
    Anchor anchor = Anchor::start;
  };
  double width_, height_;
  std::vector<Mark> marks_;
};

}  // namespace polar::report
