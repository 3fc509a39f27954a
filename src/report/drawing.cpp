#include "drawing.hpp"

#include <cmath>

#include "layout.hpp"
#include "text.hpp"

namespace polar::report {

namespace {
std::string coordinate(double value) {
  std::string text = fixed(std::isfinite(value) ? value : 0, 1);
  if (text.size() > 2 && text.compare(text.size() - 2, 2, ".0") == 0) text.resize(text.size() - 2);
  return text;
}

const char* name(Anchor anchor) {
  return anchor == Anchor::start ? "start" : anchor == Anchor::middle ? "middle" : "end";
}
}  // namespace

Path& Path::move(double x, double y) {
  d_ += "M" + coordinate(x) + " " + coordinate(y);
  return *this;
}

Path& Path::line(double x, double y) {
  d_ += "L" + coordinate(x) + " " + coordinate(y);
  return *this;
}

Path& Path::close() {
  d_ += "Z";
  return *this;
}

Path& Path::dot(double x, double y) {
  move(x, y);
  d_ += "h0";
  return *this;
}

Path& Path::circle(double x, double y, double radius) {
  const std::string r = coordinate(radius), half = "a" + r + " " + r + " 0 1 0 ";
  move(x - radius, y);
  d_ += half + coordinate(2 * radius) + " 0" + half + coordinate(-2 * radius) + " 0Z";
  return *this;
}

void Drawing::path(const std::string& style, const Path& path, const std::string& tip) {
  if (!path.empty()) marks_.push_back({Mark::Kind::path, style, path.d(), tip});
}

void Drawing::rect(const std::string& style, double x, double y, double width, double height,
                   const std::string& tip) {
  marks_.push_back({Mark::Kind::rect, style, {}, tip, x, y, width, height});
}

void Drawing::text(const std::string& style, double x, double y, const std::string& text, Anchor anchor) {
  marks_.push_back({Mark::Kind::text, style, text, {}, x, y, 0, 0, anchor});
}

void Drawing::image(double x, double y, double width, double height, const std::string& uri) {
  marks_.push_back({Mark::Kind::image, {}, uri, {}, x, y, width, height});
}

std::string Drawing::svg(const std::string& label) const {
  Data marks = list();
  for (const Mark& m : marks_) {
    Data mark;
    mark.set(m.kind == Mark::Kind::path   ? "path"
             : m.kind == Mark::Kind::rect ? "rect"
             : m.kind == Mark::Kind::text ? "text"
                                          : "image",
             true);
    mark.set("style", m.style);
    mark.set("content", utf8(m.content));
    mark.set("has_tip", !m.tip.empty());
    mark.set("tip", utf8(m.tip));
    mark.set("x", coordinate(m.x));
    mark.set("y", coordinate(m.y));
    mark.set("w", coordinate(m.width));
    mark.set("h", coordinate(m.height));
    mark.set("anchor", name(m.anchor));
    marks.push_back(mark);
  }
  Data data;
  data.set("width", coordinate(width_));
  data.set("height", coordinate(height_));
  data.set("label", utf8(label));
  data.set("marks", marks);
  return filled("figure.svg", data);
}

}  // namespace polar::report
