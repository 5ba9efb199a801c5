/// \file A participant who explores while the experimenter looks on. Private to the runner.
#pragma once

#include "protocols/session/session_desk.hpp"

#include <string>
#include <vector>

namespace touchtrial::session {

/// Passes everything on, and gives the desk its turn while the plane is on.
class AttendedExploring final : public Participant {
 public:
  explicit AttendedExploring(SessionDesk& desk)
      : desk_(desk), participant_(desk.parts().participant) {}

  void see_pictures(const std::vector<std::string>& labels) override {
    participant_.see_pictures(labels);
  }
  [[nodiscard]] std::optional<StepReply> attend(const Step& step) override {
    return participant_.attend(step);
  }
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override {
    return participant_.begin_exploring(plane);
  }
  void exploring(device::ServoControl& servo) override {
    participant_.exploring(servo);
    desk_.look(servo);
  }
  void feel(const device::ServoSample& sample) noexcept override { participant_.feel(sample); }

 private:
  SessionDesk& desk_;
  Participant& participant_;
};

}  // namespace touchtrial::session
