#include "core/nearest_name.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

constexpr std::size_t kMaxNameBytes = 64;  // longer texts are not misspelt keys

char fold_case(char c) {
  if (c >= 'A' && c <= 'Z') return static_cast<char>(c - 'A' + 'a');
  return c == '-' || c == ' ' ? '_' : c;
}

std::string fold_case(std::string_view name) {
  std::string text(name);
  for (char& c : text) c = fold_case(c);
  return text;
}

std::string without_punctuation(std::string_view name) {
  std::string text = fold_case(name);
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
  const std::string a = fold_case(a_name);
  const std::string b = fold_case(b_name);
  std::vector<std::vector<int>> cost(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) cost[i][0] = static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) cost[0][j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replacement_cost = cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, replacement_cost});
      const bool is_swap = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (is_swap) cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
    }
  }
  return cost[a.size()][b.size()];
}

std::optional<std::string_view> nearest_name(std::string_view name,
                                             std::span<const std::string_view> known_names) {
  if (name.size() > kMaxNameBytes) return std::nullopt;
  std::optional<std::string_view> nearest;
  int min_distance = 0;
  for (const std::string_view candidate : known_names) {
    const int distance = edit_distance(name, candidate);
    const int max_distance = std::max(1, static_cast<int>(candidate.size()) / 3);
    if (distance > max_distance || (nearest && distance >= min_distance)) continue;
    nearest = candidate;
    min_distance = distance;
  }
  return nearest;
}

std::optional<std::string_view> nearest_product(std::string_view name,
                                                std::span<const std::string_view> known_names) {
  if (name.size() > kMaxNameBytes) return std::nullopt;
  const std::string target = without_punctuation(name);
  const std::string number = digits_of(name);
  std::vector<std::string_view> candidates;
  for (const std::string_view candidate : known_names) {
    if (without_punctuation(candidate) == target) return candidate;
    const std::string candidate_number = digits_of(candidate);
    if (number.empty() || candidate_number.empty() || number == candidate_number)
      candidates.push_back(candidate);
  }
  const std::string base_name = target.substr(0, target.find_last_not_of("0123456789") + 1);
  const auto has_base_name = [&](std::string_view candidate) {
    return without_punctuation(candidate) == base_name;
  };
  const auto match = std::ranges::find_if(candidates, has_base_name);
  return match != candidates.end() ? *match : nearest_name(name, candidates);
}

}  // namespace touchtrial
