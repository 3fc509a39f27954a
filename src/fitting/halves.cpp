#include "halves.hpp"

#include "polar/core/rng.hpp"

namespace polar::fitting {

namespace {
constexpr std::uint32_t kJudgeStage = 0xf4;
}

Halves halves_of(const FitData& data, std::uint64_t seed, std::uint64_t particle) {
  const auto order =
      random_order(static_cast<std::size_t>(data.groups), KeyedRandom(seed, particle, kJudgeStage));
  std::vector<std::size_t> size(order.size(), 0);
  for (const int g : data.group) ++size[static_cast<std::size_t>(g)];
  std::vector<bool> judges(order.size(), false);
  const double wanted = kJudging * static_cast<double>(data.size());
  std::size_t judging = 0;
  for (const std::uint32_t g : order)
    if (static_cast<double>(judging) + 0.5 * static_cast<double>(size[g]) < wanted)
      judges[g] = true, judging += size[g];
  std::vector<std::uint32_t> fitted, held_out;
  for (std::uint32_t i = 0; i < data.size(); ++i)
    (judges[static_cast<std::size_t>(data.group[i])] ? held_out : fitted).push_back(i);
  return {some_of(data, fitted), some_of(data, held_out)};
}

}  // namespace polar::fitting
