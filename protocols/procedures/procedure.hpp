/// \file Procedures, which choose the level of each trial. A procedure is a state machine that is
/// completely determined by settings, a random stream and the answers so far. To add one, write a
/// file with its class and add a line to the list in procedure.cpp. Formulas, defaults and sources:
/// docs/thresholds.md.
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
  /// Step sizes, each >= 1. Each reversal moves to the next size, until the last one.
  std::vector<int> steps_down{4, 2, 1};
  int up_for_one_down = 1;      ///< a step up in units of a step down, >= 1; weighted: 3
  std::size_t first_level = 0;  ///< index of the first trial's level
};

/// The proportion correct p to which a staircase converges. With n right answers for a step down,
/// one wrong answer for a step up, and a step up of u steps down, p^n = u / (1 + u). With one right
/// and m wrong answers, (1 - p)^m = 1 / (1 + u). Sources: Levitt 1971; Kaernbach 1991.
/// \throws std::invalid_argument if both counts are above 1 or a number is below 1
[[nodiscard]] double convergence_of(const UpDown& rule);

/// The settings of one track. Levels are ascending; a higher level is easier.
struct TrackSettings {
  std::string procedure = "quest-plus";
  std::vector<double> levels;  ///< all possible levels; the ends are the bounds
  int trials = 60;             ///< >= 1; for constant stimuli a multiple of the number of levels
  UpDown up_down{};            ///< for the staircases
  bool blocked = false;        ///< constant stimuli: whether all trials of a level come together
  ParameterGrid grid{};        ///< for QUEST+, psi and psi-marginal
};

/// Chooses the levels of one track. Not thread-safe.
class Procedure {
 public:
  virtual ~Procedure() = default;
  /// Index of the next trial's level. It does not change until the next answer.
  [[nodiscard]] virtual std::size_t next() const = 0;
  /// Records the answer to the trial at next().
  virtual void answer(bool correct) = 0;
};

/// A kind of procedure, and its constructor.
struct ProcedureKind {
  std::string_view name;
  std::unique_ptr<Procedure> (*make)(const TrackSettings&, RandomStream&);
};

/// All kinds: constant-stimuli, up-down, weighted-up-down, quest-plus, psi, psi-marginal,
/// psi-marginal-threshold.
[[nodiscard]] std::span<const ProcedureKind> procedure_kinds();

/// \throws std::invalid_argument if the procedure does not exist or a setting is out of range
[[nodiscard]] std::unique_ptr<Procedure> make_procedure(const TrackSettings& settings,
                                                        RandomStream& stream);

}  // namespace touchtrial::procedures
