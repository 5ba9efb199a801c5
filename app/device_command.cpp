// device: force-feedback devices; device list: what is plugged in.
#include "analysis/text_table.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "device/registry.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial::app {
namespace {

struct ListArguments {
  std::filesystem::path settings;
  bool json = false;
};

constexpr std::size_t kColumns = 5;
using Row = std::array<std::string, kColumns>;

bool is_ready(const device::DeviceListing& listing) {
  return listing.present && listing.missing.empty();
}

std::string state_of(const device::DeviceListing& listing) {
  if (is_ready(listing)) return "ready";
  return listing.present ? "needs help" : "not found";
}

Row row_of(const device::DeviceListing& listing) {
  return {listing.driver, state_of(listing), listing.model, listing.serial, listing.where};
}

std::string line_of(const Row& row, const std::array<std::size_t, kColumns>& widths) {
  std::string line;
  for (std::size_t i = 0; i < kColumns; ++i) {
    line += row[i] + std::string(widths[i] - analysis::display_width(row[i]) + 2, ' ');
  }
  return line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
}

/// One row for each device; what it lacks is in lines below its row.
std::string listing_text(const std::vector<device::DeviceListing>& listings) {
  const Row header = {"driver", "state", "model", "serial", "where"};
  std::array<std::size_t, kColumns> widths{};
  const auto widen = [&](const Row& row) {
    for (std::size_t i = 0; i < kColumns; ++i) {
      widths[i] = std::max(widths[i], analysis::display_width(row[i]));
    }
  };
  widen(header);
  for (const device::DeviceListing& listing : listings) widen(row_of(listing));
  std::string text = line_of(header, widths);
  for (const device::DeviceListing& listing : listings) {
    text += line_of(row_of(listing), widths);
    for (const std::string& missing : listing.missing) text += analysis::wrapped("  - ", missing);
  }
  return text;
}

std::string listing_json(const std::vector<device::DeviceListing>& listings) {
  using nlohmann::ordered_json;
  ordered_json devices = ordered_json::array();
  for (const device::DeviceListing& listing : listings) {
    devices.push_back({{"driver", listing.driver},
                       {"model", listing.model},
                       {"serial", listing.serial},
                       {"where", listing.where},
                       {"present", listing.present},
                       {"ready", is_ready(listing)},
                       {"missing", listing.missing}});
  }
  return json_text(ordered_json{{"devices", devices}});
}

int list(const ListArguments& arguments) {
  const auto listings = device::list_devices(device::device_settings_for(arguments.settings));
  print(arguments.json ? listing_json(listings) : listing_text(listings));
  return 0;
}

void add_device_list_command(CLI::App& device, Action& action) {
  auto arguments = std::make_shared<ListArguments>();
  CLI::App* command = device.add_subcommand(
      "list", "List what is plugged in, the driver of each device, and what it still needs");
  add_settings_option(*command, arguments->settings);
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] { action = [=] { return list(*arguments); }; });
}

}  // namespace

void add_device_command(CLI::App& program, Action& action) {
  CLI::App* device = program.add_subcommand(
      "device", "Force-feedback devices: list, test, calibrate and monitor them; fit a study");
  device->require_subcommand(1);
  add_device_list_command(*device, action);
  add_device_test_command(*device, action);
  add_device_fit_command(*device, action);
  add_device_calibrate_command(*device, action);
  add_device_monitor_command(*device, action);
}

}  // namespace touchtrial::app
