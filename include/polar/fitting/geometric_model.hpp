// A geometric model: parameters with units and bounds, and parts (rings, caps, sites, ...) whose arguments
// are formulas of them. What a model file says (docs/fit.md).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "polar/fitting/expression.hpp"

namespace polar::fitting {

struct ModelParameter {
  std::string name, unit, about;
  std::vector<Expression> start;  // values to start from, formulas of `extent` (nm, see FitData)
  double low = 0, high = 0;       // bounds
  bool shared = false;            // a particle takes the superparticle's value
  bool fixed = false;             // held at its start everywhere
};

/// Primitives, in their own frame: round ones about z.
enum class Shape { point, line, ring, disc, cylinder, cap, sites };

/// What a primitive is called in a model file, and its arguments beside the common ones.
struct ShapeSpecification {
  Shape shape;
  const char* name;
  std::vector<const char*> arguments;  // lengths in nm
};
const std::vector<ShapeSpecification>& shapes();

/// Arguments that every part has: its place (nm) and a turn about y, then about z (degrees), 0 by default.
const std::vector<const char*>& placement_arguments();

struct Part {
  Shape shape = Shape::point;
  std::vector<Expression> argument;   // of its shape, in the order of ShapeSpecification::arguments
  std::vector<Expression> placement;  // in the order of placement_arguments()
  Expression share{1.0};              // localisations, relative to the other parts
  int units = 0;                      // ring: so many points evenly spaced; 0: all around
  Eigen::Matrix3Xd site_nm;           // sites
  Eigen::VectorXd site_weight;        // sites: sum 1; empty: all alike
};

/// A quantity that follows from the parameters, given with its standard error too.
struct DerivedQuantity {
  std::string name, unit, about;
  Expression value;
};

struct GeometricModel {
  std::string name, about;
  /// The first two are always `width` (nm, standard deviation of localisations about the geometry beyond
  /// their uncertainties: label and linker) and `background` (share of localisations that are spread evenly).
  std::vector<ModelParameter> parameter;
  std::vector<Part> part;
  std::vector<DerivedQuantity> derived;

  std::vector<std::string> names() const;
};
constexpr std::size_t kWidth = 0, kBackground = 1;

/// Parameters that a model may have at most.
constexpr std::size_t kMostModelParameters = 18;

/// A model without parts and with the two parameters that every one has.
GeometricModel empty_model();

}  // namespace polar::fitting
