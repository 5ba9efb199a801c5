/// \file What datasets for archives are made from, and what whoever publishes them decides.
#pragma once

#include "analysis/outcomes.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// A study, and, once it is unblinded, what it means; both or neither.
struct DatasetSource {
  const store::StudyStore& store;
  const Outcomes* outcomes = nullptr;
  const design::StudyKey* key = nullptr;
};

struct DatasetOptions {
  std::vector<std::string> authors{};
  std::string license{};             ///< for instance "CC0"; empty: not stated
  std::string institution{};         ///< where it was collected; empty: not stated
  bool traces = false;               ///< positions and forces of every trial
  bool stimuli = false;              ///< the study's images
  std::filesystem::path database{};  ///< copied along; empty: not
  std::function<void(int done, int of)> progress{};
};

/// A label for file names, unique among participants: letters and digits stand for themselves but
/// Z, which is "ZZ"; "-" is "Zd", "_" is "Zu" and "+" is "Zp". "P-07" becomes "PZd07".
[[nodiscard]] std::string participant_label(const std::string& participant);

/// The letters and digits of a name; "study" if it has none.
[[nodiscard]] std::string plain_label(const std::string& name);

}  // namespace touchtrial::analysis
