#include "core/nearest_name.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

constexpr std::size_t kMaxNameBytes = 64;  // longer texts are not misspelt keys

char folded(char c) {
  if (c >= 'A' && c <= 'Z') return static_cast<char>(c - 'A' + 'a');
  return c == '-' || c == ' ' ? '_' : c;
}

std::string folded(std::string_view name) {
  std::string text(name);
  for (char& c : text) c = folded(c);
  return text;
}

std::string without_signs(std::string_view name) {
  std::string text = folded(name);
  std::erase_if(text, [](char c) { return c == '_' || c == '.'; });
  return text;
}

std::string digits_of(std::string_view name) {
  std::string text(name);
  std::erase_if(text, [](char c) { return c < '0' || c > '9'; });
  return text;
}

}  // namespace

int edit_distance(std::string_view a_name, std::string_view b_name) {
  const std::string a = folded(a_name);
  const std::string b = folded(b_name);
  std::vector<std::vector<int>> cost(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) cost[i][0] = static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) cost[0][j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replaced = cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
    }
  }
  return cost[a.size()][b.size()];
}

std::optional<std::string_view> nearest_name(std::string_view name,
                                             std::span<const std::string_view> known) {
  if (name.size() > kMaxNameBytes) return std::nullopt;
  std::optional<std::string_view> nearest;
  int smallest = 0;
  for (const std::string_view candidate : known) {
    const int distance = edit_distance(name, candidate);
    const int allowed = std::max(1, static_cast<int>(candidate.size()) / 3);
    if (distance > allowed || (nearest && distance >= smallest)) continue;
    nearest = candidate;
    smallest = distance;
  }
  return nearest;
}

std::optional<std::string_view> nearest_product(std::string_view name,
                                                std::span<const std::string_view> known) {
  if (name.size() > kMaxNameBytes) return std::nullopt;
  const std::string wanted = without_signs(name);
  const std::string number = digits_of(name);
  std::vector<std::string_view> candidates;
  for (const std::string_view candidate : known) {
    if (without_signs(candidate) == wanted) return candidate;
    const std::string other = digits_of(candidate);
    if (number.empty() || other.empty() || number == other) candidates.push_back(candidate);
  }
  const std::string family = wanted.substr(0, wanted.find_last_not_of("0123456789") + 1);
  const auto is_family = [&](std::string_view one) { return without_signs(one) == family; };
  const auto found = std::ranges::find_if(candidates, is_family);
  return found != candidates.end() ? *found : nearest_name(name, candidates);
}

}  // namespace touchtrial
