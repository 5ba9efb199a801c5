/// \file Procedures decide which level comes next: each is a state machine that settings, a random
/// stream and the answers so far determine completely. To add one: a file with its class, and a
/// line in the list of procedure.cpp. Formulas, defaults and sources: docs/thresholds.md.
#pragma once

#include "core/random.hpp"
#include "protocols/procedures/posterior.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::procedures {

/// A staircase. Step sizes are numbers of places in the list of levels.
struct UpDown {
  int correct_for_down = 2;  ///< right answers in a row, >= 1; weighted: 1
  int wrong_for_up = 1;      ///< wrong answers in a row, >= 1; weighted: 1
  std::vector<int> steps_down{4, 2,
                              1};  ///< each >= 1; the next one at each reversal, then the last
  int up_for_one_down = 1;         ///< a step up is that many steps down, >= 1; weighted: 3
  std::size_t first_level = 0;     ///< index of the first trial's level
};

/// The proportion correct to which a staircase converges: p^n = u / (1 + u) for n right answers
/// down and one wrong up, (1 - p)^m = 1 / (1 + u) for one right down and m wrong up, with u steps
/// down in a step up. Sources: Levitt 1971; Kaernbach 1991.
/// \throws std::invalid_argument if both counts are above 1 or a number is below 1
[[nodiscard]] double convergence_of(const UpDown& rule);

/// One track. Levels are ascending: a higher one is easier.
struct TrackSettings {
  std::string procedure = "quest-plus";
  std::vector<double> levels;  ///< the only levels ever presented; the ends are the bounds
  int trials = 60;             ///< >= 1; for constant stimuli a multiple of the number of levels
  UpDown up_down{};            ///< for the staircases
  bool blocked = false;        ///< constant stimuli: all trials of a level together
  ParameterGrid grid{};        ///< for QUEST+, psi and psi-marginal
};

/// Names the levels of one track. Not thread-safe.
class Procedure {
 public:
  virtual ~Procedure() = default;
  /// Index of the next trial's level. The same until the next answer.
  [[nodiscard]] virtual std::size_t next() const = 0;
  /// The answer to the trial at next().
  virtual void answer(bool correct) = 0;
};

/// A kind of procedure, and how one is made.
struct ProcedureKind {
  std::string_view name;
  std::unique_ptr<Procedure> (*make)(const TrackSettings&, RandomStream&);
};

/// Every kind: constant-stimuli, up-down, weighted-up-down, quest-plus, psi, psi-marginal,
/// psi-marginal-threshold.
[[nodiscard]] std::span<const ProcedureKind> procedure_kinds();

/// \throws std::invalid_argument if there is no such procedure or a setting is outside its range
[[nodiscard]] std::unique_ptr<Procedure> make_procedure(const TrackSettings& settings,
                                                        RandomStream& stream);

}  // namespace touchtrial::procedures
