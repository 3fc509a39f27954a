#include "polar/fitting/geometric_model.hpp"

namespace polar::fitting {

namespace {
// Of a label and its linker: a few nm; more than 50 nm is no label.
constexpr double kMostWidth_nm = 50, kLeastWidth_nm = 0.05;
constexpr double kMostBackground = 0.95;
}  // namespace

const std::vector<ShapeSpecification>& shapes() {
  static const std::vector<ShapeSpecification> kShapes = {{Shape::point, "point", {}},
                                                          {Shape::line, "line", {"length"}},
                                                          {Shape::ring, "ring", {"radius"}},
                                                          {Shape::disc, "disc", {"radius"}},
                                                          {Shape::cylinder, "cylinder", {"radius", "length"}},
                                                          {Shape::cap, "cap", {"radius", "opening_deg"}},
                                                          {Shape::sites, "sites", {"scale"}}};
  return kShapes;
}

const std::vector<const char*>& placement_arguments() {
  static const std::vector<const char*> kPlacement = {"x", "y", "z", "tilt_deg", "turn_deg"};
  return kPlacement;
}

std::vector<std::string> GeometricModel::names() const {
  std::vector<std::string> list;
  for (const ModelParameter& p : parameter) list.push_back(p.name);
  return list;
}

GeometricModel empty_model() {
  GeometricModel model;
  // Wide at first: from afar a structure is a cloud, and nothing is missed.
  model.parameter = {{"width",
                      "nm",
                      "standard deviation about the geometry beyond the localisations' own: label, linker",
                      {Expression("extent / 5", {"extent"})},
                      kLeastWidth_nm,
                      kMostWidth_nm,
                      true},
                     {"background",
                      "1",
                      "share of the localisations that are spread evenly",
                      {Expression(0.05)},
                      0,
                      kMostBackground,
                      false}};
  return model;
}

}  // namespace polar::fitting
