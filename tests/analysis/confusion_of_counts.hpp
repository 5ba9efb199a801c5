/// \file A confusion matrix from its counts.
#pragma once

#include "analysis/statistics/confusion.hpp"

#include <vector>

namespace touchtrial {

/// \param counts  rows are the presented class, columns the answer
inline analysis::ConfusionMatrix confusion_of_counts(const std::vector<std::vector<int>>& counts) {
  analysis::ConfusionMatrix confusion(static_cast<int>(counts.size()));
  for (int i = 0; i < confusion.classes(); ++i) {
    for (int j = 0; j < confusion.classes(); ++j) {
      for (int k = 0; k < counts[i][j]; ++k) confusion.add({i, j});
    }
  }
  return confusion;
}

}  // namespace touchtrial
