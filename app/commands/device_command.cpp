// device: adds list, initialise (homes a device) and models; other subcommands have their own
// files.
#include "analysis/report/text_table.hpp"
#include "app/commands/commands.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "device/drivers/registry.hpp"
#include "device/model/device_model.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
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

/// \return the other names of a driver, for instance "touch, omni"; may be empty
std::string other_names_of(const std::string& driver) {
  const auto names = device::device_driver(driver).names();
  return fmt::format("{}", fmt::join(names.begin() + 1, names.end(), ", "));
}

/// One row per device. The lines below it state what it lacks and what a study must consider; below
/// a driver's first row, also the driver's other names.
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
  std::string driver;
  for (const device::DeviceListing& listing : listings) {
    text += line_of(row_of(listing), widths);
    const std::string other_names = other_names_of(listing.driver);
    if (listing.driver != driver && !other_names.empty()) {
      text += analysis::wrapped("  ", "also known as " + other_names);
    }
    driver = listing.driver;
    for (const std::string& missing : listing.missing) text += analysis::wrapped("  - ", missing);
    for (const std::string& note : listing.notes) text += analysis::wrapped("  ", note);
  }
  return text;
}

nlohmann::ordered_json products_json(const std::string& driver) {
  nlohmann::ordered_json products = nlohmann::ordered_json::array();
  for (const device::DeviceProduct& product : device::device_driver(driver).products) {
    products.push_back({{"name", product.name}, {"title", product.title}});
  }
  return products;
}

std::string listing_json(const std::vector<device::DeviceListing>& listings) {
  using nlohmann::ordered_json;
  ordered_json devices = ordered_json::array();
  for (const device::DeviceListing& listing : listings) {
    devices.push_back({{"driver", listing.driver},
                       {"products", products_json(listing.driver)},
                       {"model", listing.model},
                       {"serial", listing.serial},
                       {"where", listing.where},
                       {"present", listing.present},
                       {"ready", is_ready(listing)},
                       {"missing", listing.missing},
                       {"notes", listing.notes}});
  }
  return json_text(ordered_json{{"devices", devices}});
}

int list(const ListArguments& arguments) {
  const auto listings = device::list_devices(device::load_device_settings(arguments.settings));
  print(arguments.json ? listing_json(listings) : listing_text(listings));
  return 0;
}

void add_device_list_command(CLI::App& device, Action& action) {
  auto arguments = std::make_shared<ListArguments>();
  CLI::App* command = device.add_subcommand(
      "list", "List connected devices, their drivers, and what they still need");
  add_settings_option(*command, arguments->settings);
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] { action = [=] { return list(*arguments); }; });
}

struct InitialiseArguments {
  std::string driver;
  std::filesystem::path settings;
  bool yes = false;
};

int initialise(const InitialiseArguments& arguments) {
  const device::DeviceDriver& driver = device::device_driver(arguments.driver);
  if (!driver.initialise) {
    throw UsageError(driver.name +
                     ": cannot move itself to its axes' origins; touchtrial device test " +
                     driver.name + " explains what a person must do");
  }
  confirm(driver.name +
              ": the arm will move by itself, with force, through its whole range; take "
              "your hands and everything else away from it",
          arguments.yes);
  print(driver.name + " " + driver.initialise(device::load_device_settings(arguments.settings)) +
        "\n");
  return 0;
}

void add_device_initialise_command(CLI::App& device, Action& action) {
  auto arguments = std::make_shared<InitialiseArguments>();
  CLI::App* command = device.add_subcommand(
      "initialise", "Home a device, which moves by itself; asks before it moves");
  add_driver_argument(*command, "NAME", arguments->driver)->required();
  add_settings_option(*command, arguments->settings);
  add_yes_flag(*command, arguments->yes);
  command->callback([=, &action] { action = [=] { return initialise(*arguments); }; });
}

/// A number of a model: "-" if it is unknown or the model omits the effect; with "?" if it is a
/// guess.
std::string model_number_text(const device::DeviceModel& model, const std::string& key,
                              double number) {
  if (number == 0.0) return "-";
  const auto entry = model.provenance.find(key);
  const bool is_guess =
      entry != model.provenance.end() && entry->second.confidence == device::Confidence::guess;
  return fmt::format("{:g}{}", number, is_guess ? "?" : "");
}

std::string models_text() {
  analysis::TextTable table(
      {"model", "device", "mass kg", "friction N", "step mm", "peak N", "continuous N", "delay"},
      {0, 1});
  for (const device::DeviceModel& m : device::shipped_device_models()) {
    table.add({m.name, m.title, model_number_text(m, "mass_kg", m.mass_kg),
               model_number_text(m, "coulomb_n", m.coulomb_n),
               model_number_text(m, "position_step_mm", m.position_step_mm),
               model_number_text(m, "max_force_n", m.max_force_n),
               model_number_text(m, "continuous_force_n", m.continuous_force_n),
               model_number_text(m, "delay_ticks", m.delay_ticks)});
  }
  return table.text() + "\n" +
         analysis::wrapped("",
                           "?: a guess. The delay is in ticks of 1 ms. No number was measured on a "
                           "device; --json gives the source of each.");
}

std::string models_json() {
  using nlohmann::ordered_json;
  ordered_json models = ordered_json::array();
  for (const device::DeviceModel& model : device::shipped_device_models()) {
    models.push_back(ordered_json::parse(device::device_model_json(model)));
  }
  return json_text(ordered_json{{"models", models}});
}

void add_device_models_command(CLI::App& device, Action& action) {
  auto json = std::make_shared<bool>(false);
  CLI::App* command =
      device.add_subcommand("models", "List the built-in device models for rehearsals");
  add_json_flag(*command, *json);
  command->callback([=, &action] {
    action = [=] {
      print(*json ? models_json() : models_text());
      return 0;
    };
  });
}

}  // namespace

void add_device_command(CLI::App& program, Action& action) {
  CLI::App* device = program.add_subcommand(
      "device", "Force-feedback devices: list, test and accept them; fit a study; check a driver");
  device->require_subcommand(1);
  add_device_list_command(*device, action);
  add_device_initialise_command(*device, action);
  add_device_test_command(*device, action);
  add_device_fit_command(*device, action);
  add_device_bring_up_command(*device, action);
  add_device_accept_command(*device, action);
  add_device_models_command(*device, action);
  add_device_conform_command(*device, action);
}

}  // namespace touchtrial::app
