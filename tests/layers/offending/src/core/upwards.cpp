// Not compiled: what the layer guard must report.

#include "polar/results/compare.hpp"
