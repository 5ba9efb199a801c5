#include "app/run/run_experimenter.hpp"

#include "app/console.hpp"
#include "app/run/ending_signals.hpp"

#include <utility>

namespace touchtrial::app {

RunExperimenter::RunExperimenter(session::Experimenter& inner, std::function<std::string()> gone,
                                 std::function<std::optional<session::ExperimenterRequest>()> more)
    : inner_(inner), gone_(std::move(gone)), more_(std::move(more)) {}

std::optional<session::ExperimenterRequest> RunExperimenter::request() {
  std::string why = EndingSignals::message();
  if (why.empty() && gone_) why = gone_();
  if (!why.empty())
    return session::ExperimenterRequest{session::ExperimenterRequest::Kind::leave, why, ""};
  if (auto request = more_ ? more_() : std::nullopt) return request;
  return inner_.request();
}

void RunExperimenter::acknowledged(int trial) {
  print("trial " + std::to_string(trial) + " acknowledged\n");
  inner_.acknowledged(trial);
}

}  // namespace touchtrial::app
