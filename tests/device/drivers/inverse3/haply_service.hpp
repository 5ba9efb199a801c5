/// \file The emulated Inverse service (inverse3_service.py) as a program beside the test.
#pragma once

#include "device/device_settings.hpp"
#include "support/child_process.hpp"

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial::testing {

/// Listens on free ports of this machine while the object lives.
class HaplyService {
 public:
  /// \param options  of the program, for instance {"--version", "3.1"}
  /// \throws std::runtime_error with the remedy if it does not start
  explicit HaplyService(std::vector<std::string> options = {});

  /// The driver's settings for it.
  [[nodiscard]] device::Inverse3Settings settings() const;
  /// Gives it a command; inverse3_service.py lists them.
  void send_command(const std::string& command);
  /// Sends an event and waits until it is sent.
  void send_event(const nlohmann::json& event);
  /// What it has been told up to now.
  [[nodiscard]] nlohmann::json report();

  /// It dies at once; the connections end.
  void kill();
  [[nodiscard]] bool runs() const noexcept { return process_.has_value(); }
  /// After `kill`: it listens where it did.
  void start_again();

 private:
  void start();
  /// \return the next line of its output that begins with this
  [[nodiscard]] std::string next_line(const std::string& beginning);

  std::vector<std::string> options_;
  std::optional<ChildProcess> process_;
  std::size_t read_ = 0;  ///< of its output
  int port_ = 0;
  int events_port_ = 0;
  int http_port_ = 0;
};

}  // namespace touchtrial::testing
