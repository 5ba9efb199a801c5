#include "device/drivers/inverse3/haply_service.hpp"

#include <sstream>
#include <stdexcept>
#include <utility>

namespace touchtrial::testing {
namespace {

/// Debian's own: others on the path need not have the packages.
constexpr const char* kPython = "/usr/bin/python3";
/// Long enough that only a program that hangs is given up.
constexpr int kLooks = 300;

}  // namespace

HaplyService::HaplyService(std::vector<std::string> options) : options_(std::move(options)) {
  start();
}

void HaplyService::start() {
  std::vector<std::string> arguments = {
      kPython,         TOUCHTRIAL_INVERSE3_SERVICE,  "--port",      std::to_string(port_),
      "--events-port", std::to_string(events_port_), "--http-port", std::to_string(http_port_)};
  arguments.insert(arguments.end(), options_.begin(), options_.end());
  process_.emplace(arguments, std::vector<std::string>{});
  read_ = 0;
  std::istringstream(next_line("ready ").substr(6)) >> port_ >> events_port_ >> http_port_;
}

std::string HaplyService::next_line(const std::string& beginning) {
  for (int look = 0; look < kLooks;) {
    const std::size_t end = process_->output().find('\n', read_);
    if (end != std::string::npos) {
      std::string line = process_->output().substr(read_, end - read_);
      read_ = end + 1;
      if (line.compare(0, beginning.size(), beginning) == 0) return line;
      continue;
    }
    if (!process_->listen(std::chrono::seconds(1))) break;
    ++look;
  }
  throw std::runtime_error(
      "the emulated Inverse service does not run; it needs python3-websockets: run "
      "scripts/install-dependencies tests\n" +
      process_->output());
}

device::Inverse3Settings HaplyService::settings() const {
  device::Inverse3Settings settings{.host = "127.0.0.1", .port = port_, .http_port = http_port_};
  // Without the channel: one where nobody listens.
  settings.events_port = events_port_ == 0 ? 1 : events_port_;
  return settings;
}

void HaplyService::send_command(const std::string& command) {
  process_->write(command + '\n');
}

void HaplyService::send_event(const nlohmann::json& event) {
  send_command("event " + event.dump());
  (void)next_line("sent");
}

nlohmann::json HaplyService::report() {
  send_command("report");
  return nlohmann::json::parse(next_line("{"));
}

void HaplyService::kill() {
  process_.reset();
}

void HaplyService::start_again() {
  start();
}

}  // namespace touchtrial::testing
