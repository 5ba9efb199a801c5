#include "engine/extraction.hpp"

#include <array>
#include <cstddef>

namespace touchtrial {
namespace {

constexpr std::array<std::string_view, 3> kNames = {"adaptive", "fixed", "tv-gabor"};

}  // namespace

std::string_view name_of(Method method) {
  return kNames.at(static_cast<std::size_t>(method));
}

std::optional<Method> method_from_name(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) return static_cast<Method>(i);
  }
  return std::nullopt;
}

std::vector<std::string> method_names() {
  return {kNames.begin(), kNames.end()};
}

}  // namespace touchtrial
