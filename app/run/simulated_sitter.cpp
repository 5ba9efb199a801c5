#include "app/run/simulated_sitter.hpp"

#include "app/simulated_study.hpp"
#include "device/simulated/simulated_hand.hpp"
#include "protocols/session/device_station.hpp"
#include "protocols/session/real_time_explorer.hpp"

#include <algorithm>
#include <thread>
#include <utility>

namespace touchtrial {

SimulatedSitter simulated_sitter_for(const RunOptions& options, const RunStudy& study,
                                     const StimulusSource& source) {
  SubjectModel subject = subject_for(*options.subject, study.key.study);
  FeltKnowledge knowledge = learn_by_feeling(
      LabelledFields(study.key, source), subject, study.key.study.rendering.max_force_n,
      options.seed, static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
  return {std::move(subject), std::move(knowledge)};
}

SimulatedCourse simulated_course(const RunOptions& options) {
  if (options.real_time) return {std::make_unique<RealTimeExplorer>()};
  return {std::make_unique<VirtualExplorer>()};
}

void SimulatedCourse::describe(SessionOpening& opening) const {
  opening.device = "simulated";
  if (const auto* const real_time = dynamic_cast<const RealTimeExplorer*>(explorer.get())) {
    const DeviceInfo device{"simulated", "", HandOptions{}.max_force_n, true};
    describe_station(opening, device, real_time->scheduling(), kServoRateHz, "");
  }
  opening.simulated = true;
}

std::unique_ptr<SessionClock> SimulatedCourse::clock(std::chrono::nanoseconds start) const {
  if (explorer->in_real_time()) return std::make_unique<SteadySessionClock>(start);
  return std::make_unique<VirtualSessionClock>(start);
}

}  // namespace touchtrial
