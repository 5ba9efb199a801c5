/// \file How long measuring may take.
#pragma once

namespace touchtrial::bench {

struct Effort {
  int repetitions = 7;         ///< of a row; fewer of large images
  double repetition_s = 0.02;  ///< at least, and one run
  double pair_s = 3.0;         ///< for one goal, about
  int least_rounds = 5;        ///< of a pair, however long they take
  int most_rounds = 41;
  int tv_gabor_pictures = 100;  ///< at most; each takes seconds
  int study_rounds = 3;         ///< of a whole simulated study
};

/// For looking whether everything works.
[[nodiscard]] constexpr Effort quick_effort() {
  return {3, 0.002, 0.2, 3, 15, 2, 1};
}

}  // namespace touchtrial::bench
