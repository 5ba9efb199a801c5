#include "app/commands.hpp"

namespace touchtrial::app {

void add_settings_option(CLI::App& command, std::filesystem::path& settings) {
  command.add_option("--settings", settings,
                     "Device settings (default: touchtrial/devices.json in the user's "
                     "configuration folder, if there)");
}

void add_device_command(CLI::App& program, Action& action) {
  CLI::App* device = program.add_subcommand(
      "device", "Force-feedback devices: what is there, does it work, does a study fit");
  device->require_subcommand(1);
  add_device_list_command(*device, action);
  add_device_test_command(*device, action);
  add_device_fit_command(*device, action);
  add_device_calibrate_command(*device, action);
  add_device_monitor_command(*device, action);
}

}  // namespace touchtrial::app
