/// \file Whoever runs the session, and what the program itself has to say meanwhile.
#pragma once

#include "protocols/session/experimenter.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// Passes everything on to the experimenter's terminal or window; prints a line to standard output
/// for each durable response; and leaves the session when the program is to end.
class RunExperimenter final : public session::Experimenter {
 public:
  /// \param inner  must outlive this
  /// \param gone  why the program is to end, beside signals; empty as long as it is not
  /// \param more  requests that something else makes, such as the sound; empty: nothing does
  RunExperimenter(session::Experimenter& inner, std::function<std::string()> gone,
                  std::function<std::optional<session::ExperimenterRequest>()> more = {});

  void show(const session::SessionStatus& status) override { inner_.show(status); }
  [[nodiscard]] std::optional<session::ExperimenterRequest> request() override;
  [[nodiscard]] std::optional<std::vector<session::Tick>> day_sheet(
      const std::vector<session::DaySheetItem>& items) override {
    return inner_.day_sheet(items);
  }
  void acknowledged(int trial) override;

 private:
  session::Experimenter& inner_;
  std::function<std::string()> gone_;
  std::function<std::optional<session::ExperimenterRequest>()> more_;
};

}  // namespace touchtrial::app
