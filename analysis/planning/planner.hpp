/// \file The interface between planning commands and the protocols.
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "analysis/planning/power_curve.hpp"
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

/// The options of `power`. Only some protocols accept those from `methods` on (Planner::options).
struct PowerOptions {
  PowerPlan plan;  ///< validated; only some protocols use explorations and trainings
  int jobs = 1;    ///< threads; results do not depend on them
  bool json = false;

  std::vector<std::string> methods{};  ///< labels of two methods; empty: the study's
  std::optional<double> margin{};
  std::optional<double> mean{};  ///< mean accuracy of people, instead of simulated hands
  double sd_between = 0.0;
  std::optional<double> accuracy{};
  std::string trials{};      ///< of a track, as typed; empty: the study's
  std::string difference{};  ///< two standards, as typed; empty: the first two, if there are two
  std::optional<double> width_db{};
  int pool = 100;  ///< simulated participants from whom samples are drawn
};

/// Program functions that a planner may call. Inputs are made only when needed.
struct PowerTools {
  std::function<simulation::SubjectModel()>
      subject;                           ///< the user's subject model, or the built-in one
  std::function<study::StudyKey()> key;  ///< of the study, for simulations
  std::function<void(const study::StudyKey&)> prepare;  ///< makes what its pack lacks
  /// A progress bar with this label.
  std::function<study::Progress(const std::string&)> progress;
};

/// A planner's result.
struct PowerResult {
  std::string text;  ///< output of `power`
  PowerCurve curve;  ///< without series if the options state no goal that studies reach or miss
};

/// The part of a protocol that plans studies. Stateless and thread-safe.
class Planner {
 public:
  virtual ~Planner() = default;

  /// Options of `power` that it accepts in addition to the common options, for example "--methods".
  [[nodiscard]] virtual std::span<const std::string_view> options() const = 0;
  /// Simulates a study many times.
  /// \throws UsageError if an option is impossible for the study
  /// \throws StudyError if power is undefined for the study
  [[nodiscard]] virtual PowerResult power(const study::Study& study, const PowerOptions& options,
                                          const PowerTools& tools) const = 0;

  /// A shipped study with tracks for `procedure`; empty: the protocol has no tracks.
  [[nodiscard]] virtual std::string_view study_with_tracks() const;
  /// Replays answers, each right or wrong, through one track of a study.
  /// \param track  from 1
  /// \return what `procedure` prints
  /// \throws UsageError if the protocol has no tracks, the track does not exist, or there are more
  ///   answers than trials
  [[nodiscard]] virtual std::string procedure(const study::Study& study, int track,
                                              const std::vector<bool>& answers) const;

  /// The mean measured detection threshold along gain for each class label, dB, at the share of
  /// right answers that defines a level of 0 dB.
  /// \param outcomes  unblinded
  /// \param place  prefix of error messages
  /// \throws StudyError if the study measured no such thresholds, or too few
  [[nodiscard]] virtual std::vector<std::pair<std::string, double>> pilot_thresholds(
      const analysis::Outcomes& outcomes, const std::string& place) const;
};

/// Registers a protocol's planner. Call before the first use. Not thread-safe.
/// \param protocol  the protocol's name; both arguments must outlive the program's use of them
void add_planner(std::string_view protocol, const Planner& planner);

/// \param what  what needs the planner, for the message: "`power`"
/// \throws StudyError if the study's protocol has no planner
[[nodiscard]] const Planner& planner_of(const study::Study& study, const std::string& what);

/// The protocols whose studies accept an option of `power`; empty if all do.
/// \param option  as "--methods"
[[nodiscard]] std::vector<std::string_view> protocols_with(std::string_view option);

}  // namespace touchtrial::planning
