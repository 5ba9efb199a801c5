/// \file The interface of a protocol's planning: what commands that plan ask of a protocol. They
/// know the planning of a protocol only by this interface.
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "analysis/planning/power_plan.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "study/prepare.hpp"
#include "study/study_key.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::planning {

/// The options of `power`. Those from `methods` on are of some protocols only (Planner::options).
struct PowerOptions {
  PowerPlan plan;  ///< settled; some protocols alone use explorations and trainings
  int jobs = 1;    ///< threads; results do not depend on them
  bool json = false;

  std::vector<std::string> methods{};  ///< labels of two; empty: the study's
  std::optional<double> margin{};
  std::optional<double> mean{};  ///< of people, in place of simulated hands
  double sd_between = 0.0;
  std::optional<double> accuracy{};
  std::string trials{};      ///< of a track, as typed; empty: the study's
  std::string difference{};  ///< two standards, as typed; empty: the first two, if there are two
  std::optional<double> width_db{};
  int pool = 100;  ///< simulated participants from whom samples are drawn
};

/// What a planner uses of the program. What it does not need is not made.
struct PowerTools {
  std::function<simulation::SubjectModel()> subject;  ///< that the user named, or the built-in one
  std::function<study::StudyKey()> key;               ///< of the study, for simulations
  std::function<void(const study::StudyKey&)> prepare;  ///< makes what its pack lacks
  /// A bar that shows how far the work is that the words name.
  std::function<study::Progress(const std::string&)> progress;
};

/// The part of a protocol that plans studies. Stateless and thread-safe.
class Planner {
 public:
  virtual ~Planner() = default;

  /// Options of `power` that it takes beside those of every protocol, as "--methods".
  [[nodiscard]] virtual std::span<const std::string_view> options() const = 0;
  /// Simulates a study many times.
  /// \return what `power` prints
  /// \throws UsageError if an option is impossible for the study
  /// \throws StudyError if the study has no power
  [[nodiscard]] virtual std::string power(const study::Study& study, const PowerOptions& options,
                                          const PowerTools& tools) const = 0;

  /// A study that comes with the program and has the tracks of `procedure`; empty: the protocol has
  /// none.
  [[nodiscard]] virtual std::string_view study_with_tracks() const;
  /// One track of a study after a list of answers, each right or not.
  /// \param track  from 1
  /// \return what `procedure` prints
  /// \throws UsageError if the protocol has no tracks, the track is not there, or there are more
  ///   answers than trials
  [[nodiscard]] virtual std::string procedure(const study::Study& study, int track,
                                              const std::vector<bool>& answers) const;

  /// Mean measured thresholds of detection along gain, dB, of each class's label, at the share of
  /// right answers that levels count from.
  /// \param outcomes  unblinded
  /// \param place  with which an error begins
  /// \throws StudyError if the study measured no such thresholds, or too few
  [[nodiscard]] virtual std::vector<std::pair<std::string, double>> pilot_thresholds(
      const analysis::Outcomes& outcomes, const std::string& place) const;
};

/// Registers a protocol's planner. Call before the first use. Not thread-safe.
/// \param protocol  the protocol's name; both arguments must outlive the program's use of them
void add_planner(std::string_view protocol, const Planner& planner);

/// \param what  is asked of it, in words: "`power`"
/// \throws StudyError if the study's protocol has no planner
[[nodiscard]] const Planner& planner_of(const study::Study& study, const std::string& what);

/// The protocols whose studies take an option of `power`; none if those of all take it.
/// \param option  as "--methods"
[[nodiscard]] std::vector<std::string_view> protocols_with(std::string_view option);

}  // namespace touchtrial::planning
