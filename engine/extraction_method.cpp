#include "engine/extraction.hpp"

#include <array>

namespace touchtrial::engine {
namespace {

constexpr std::array<std::string_view, 7> kNames = {"adaptive", "fixed", "tv-gabor", "gaussian",
                                                    "median",   "edge",  "luminance"};

}  // namespace

std::string_view name_of(Method method) {
  return name_among(kNames, method);
}

std::optional<Method> method_from_name(std::string_view name) {
  return choice_named<Method>(kNames, name);
}

std::vector<std::string> method_names() {
  return {kNames.begin(), kNames.end()};
}

}  // namespace touchtrial::engine
