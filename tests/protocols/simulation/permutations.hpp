/// \file Whether presentations of one stimulus are more alike than others, in any of several
/// features.
#pragma once

#include "core/random.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial {

inline constexpr int kPresentations = 25;  ///< of each session
inline constexpr int kStimuli = 6;

/// One value of each trial, of all sessions one after the other.
using Values = std::vector<double>;
using Features = std::map<std::string, Values>;

/// Ranks within each session, less their mean, over their standard deviation: so every session
/// counts the same. Equal values have equal ranks. Zeros where all are equal.
inline Values ranked(const Values& values) {
  Values ranks(values.size());
  for (std::size_t begin = 0; begin < values.size(); begin += kPresentations) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(begin);
    double squares = 0.0;
    for (std::size_t i = 0; i < kPresentations; ++i) {
      const auto below = std::count_if(first, first + kPresentations,
                                       [&](double other) { return other < first[i]; });
      const auto above = std::count_if(first, first + kPresentations,
                                       [&](double other) { return other > first[i]; });
      ranks[begin + i] = static_cast<double>(below - above);
      squares += ranks[begin + i] * ranks[begin + i];
    }
    for (std::size_t i = 0; squares > 0.0 && i < kPresentations; ++i) {
      ranks[begin + i] /= std::sqrt(squares);
    }
  }
  return ranks;
}

/// Between stimuli, of all sessions: the sum of the squares of the sums, each over the number of
/// presentations.
inline double squares_between(const Values& ranks, const std::vector<int>& stimuli) {
  double sum = 0.0;
  for (std::size_t begin = 0; begin < ranks.size(); begin += kPresentations) {
    std::array<double, kStimuli> sums{};
    std::array<int, kStimuli> counts{};
    for (std::size_t i = begin; i < begin + kPresentations; ++i) {
      sums.at(static_cast<std::size_t>(stimuli[i])) += ranks[i];
      ++counts.at(static_cast<std::size_t>(stimuli[i]));
    }
    for (std::size_t s = 0; s < kStimuli; ++s) sum += sums[s] * sums[s] / std::max(1, counts[s]);
  }
  return sum;
}

inline constexpr int kPermutations = 4'999;

/// The probability of values as much alike within stimuli as these, if the stimuli of each session
/// had come in any other order.
inline std::map<std::string, double> probabilities(const Features& features,
                                                   std::vector<int> stimuli) {
  std::map<std::string, Values> ranks;
  std::map<std::string, double> found;
  std::map<std::string, int> reached;
  for (const auto& [name, values] : features) {
    REQUIRE(values.size() == stimuli.size());
    ranks[name] = ranked(values);
    found[name] = squares_between(ranks[name], stimuli);
  }
  // What is the same in all trials of each session links nothing.
  std::erase_if(ranks, [&](const auto& feature) {
    return std::ranges::all_of(feature.second, [](double rank) { return rank == 0.0; });
  });
  RandomStream random(23, "permutations");
  for (int i = 0; i < kPermutations; ++i) {
    for (std::size_t begin = 0; begin < stimuli.size(); begin += kPresentations) {
      shuffle(std::span(stimuli).subspan(begin, kPresentations), random);
    }
    for (const auto& [name, of_trials] : ranks) {
      if (squares_between(of_trials, stimuli) >= found[name] * (1.0 - 1e-12)) ++reached[name];
    }
  }
  std::map<std::string, double> p;
  for (const auto& [name, of_trials] : ranks) p[name] = (1.0 + reached[name]) / (1 + kPermutations);
  return p;
}

/// The features that link presentations at 1 % of all of them together (Holm).
inline std::set<std::string> links(const std::map<std::string, double>& probabilities) {
  std::vector<std::pair<double, std::string>> by_p;
  for (const auto& [name, p] : probabilities) by_p.emplace_back(p, name);
  std::ranges::sort(by_p);
  std::set<std::string> found;
  for (std::size_t i = 0; i < by_p.size(); ++i) {
    if (by_p[i].first > 0.01 / static_cast<double>(by_p.size() - i)) break;
    found.insert(by_p[i].second);
  }
  return found;
}

}  // namespace touchtrial
