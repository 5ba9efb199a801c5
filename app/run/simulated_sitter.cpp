#include "app/run/simulated_sitter.hpp"

#include "app/simulated_study.hpp"
#include "device/simulated/simulated_hand.hpp"
#include "protocols/session/device_station.hpp"
#include "protocols/session/real_time_explorer.hpp"

#include <algorithm>
#include <thread>
#include <utility>

namespace touchtrial::app {

SimulatedSitter simulated_sitter_for(const RunOptions& options, const RunStudy& study,
                                     const session::StimulusSource& source) {
  session::SubjectModel subject = subject_for(*options.subject, study.key.study);
  session::FeltKnowledge knowledge = session::learn_by_feeling(
      session::LabelledFields(study.key, source), subject, study.key.study.rendering.max_force_n,
      options.seed, static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
  return {std::move(subject), std::move(knowledge)};
}

SimulatedCourse simulated_course(const RunOptions& options) {
  if (options.real_time) return {std::make_unique<session::RealTimeExplorer>()};
  return {std::make_unique<session::VirtualExplorer>()};
}

void SimulatedCourse::describe(store::SessionOpening& opening) const {
  opening.device = "simulated";
  if (const auto* const real_time =
          dynamic_cast<const session::RealTimeExplorer*>(explorer.get())) {
    const device::DeviceInfo device{"simulated", "", device::HandOptions{}.max_force_n, true};
    session::describe_station(opening, device, real_time->scheduling(), device::kServoRateHz, "");
  }
  opening.simulated = true;
}

std::unique_ptr<session::SessionClock> SimulatedCourse::clock(
    std::chrono::nanoseconds start) const {
  if (explorer->in_real_time()) return std::make_unique<session::SteadySessionClock>(start);
  return std::make_unique<session::VirtualSessionClock>(start);
}

}  // namespace touchtrial::app
