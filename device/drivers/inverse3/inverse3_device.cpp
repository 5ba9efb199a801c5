#include "device/drivers/inverse3/inverse3_device.hpp"

#include "core/errors.hpp"
#include "core/strict_json.hpp"
#include "device/drivers/drivers.hpp"
#include "device/platform/realtime.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchtrial::device::inverse3 {
namespace {

using std::chrono::milliseconds;

constexpr double kMmPerM = 1000.0;
constexpr double kRateHz = 1e9 / static_cast<double>(Inverse3Device::kPeriod.count());
/// Radius of the sphere that the arm reaches, mm.
constexpr double kInverse3RadiusMm = 100.0;
constexpr double kMinverseRadiusMm = 40.0;
/// A position further from the centre is invalid, m.
constexpr double kMaxM = 1.0;
/// The centre of the workspace in the arm's base frame, which services before 3.5 use, m. Estimated
/// from examples in the documentation; not verified.
constexpr Vec3 kCentreInBaseFrameM = {0.0, -0.12, 0.15};
/// Maximum number of queries until the configuration matches.
constexpr int kMaxReadBacks = 20;
constexpr milliseconds kReadBackInterval{10};  ///< between these queries
constexpr milliseconds kListTimeout{5000};
constexpr milliseconds kFinalTimeout{200};

/// Converts from the service's axes (x right, y away from the person, z up) to the device frame.
Vec3 to_device_axes(Vec3 service) noexcept {
  return {service.x, service.z, -service.y};
}
Vec3 to_service_axes(Vec3 device) noexcept {
  return {device.x, -device.z, device.y};
}

std::string model_of(const std::string& type) {
  if (type == "inverse3") return "Haply Inverse3";
  if (type == "inverse3x") return "Haply Inverse3x";
  if (type == "minverse") return "Haply Minverse";
  return one_line("Haply " + type);
}

ServiceAddress address_of(const Inverse3Settings& settings) {
  return {settings.host, settings.port};
}

/// \return the answer to a query
/// \throws DeviceError if the service does not provide the path
std::string required_answer(const ServiceAddress& http, const std::string& path,
                            std::chrono::nanoseconds timeout) {
  const HttpAnswer answer = query_service(http, path, timeout);
  if (answer.status == 200) return answer.body;
  throw DeviceError(one_line("inverse3: the service at " + http.text() + " does not provide " +
                             path + " (HTTP " + std::to_string(answer.status) +
                             "); update Haply's Inverse service, to 3.5 or later"));
}

[[noreturn]] void refuse_message(const ServiceAddress& service, const std::string& subject,
                                 const BadMessage& error) {
  throw DeviceError(one_line("inverse3: " + subject + " from " + service.text() + " is invalid (" +
                             error.what() +
                             "); correct inverse3.host and inverse3.port, or update the service"));
}

ServiceInfo check_service(const ServiceAddress& http, const std::string& version_answer) {
  ServiceVersion version;
  try {
    version = parse_version(version_answer);
  } catch (const BadMessage& error) {
    refuse_message(http, "the version", error);
  }
  if (version.is_supported()) return {version, http};
  throw DeviceError("inverse3: the service at " + one_line(http.text()) + " has version " +
                    version.text() + ", but only 3.1 to 3.x are supported; install 3.5 or later");
}

/// Finds an older service, up to early 3.5, which has HTTP on a separate port.
/// \return nothing if that port has no HTTP either
std::optional<ServiceInfo> find_older_service(const Inverse3Settings& settings,
                                              std::chrono::nanoseconds timeout) {
  const ServiceAddress http{settings.host, settings.http_port};
  HttpAnswer answer;
  try {
    answer = query_service(http, "/version", timeout);
  } catch (const DeviceError&) {
    return std::nullopt;
  }
  if (answer.status == 200) return check_service(http, answer.body);
  throw DeviceError(one_line("inverse3: the service at " + http.text() +
                             " does not provide /version (HTTP " + std::to_string(answer.status) +
                             "), so it is older than 3.1; install Haply's Inverse service 3.5 or "
                             "later"));
}

ServiceInfo find_service(const Inverse3Settings& settings, std::chrono::nanoseconds timeout) {
  const ServiceAddress default_address = address_of(settings);
  std::string error;
  try {
    const HttpAnswer answer = query_service(default_address, "/version", timeout);
    if (answer.status == 200) return check_service(default_address, answer.body);
    error = "inverse3: neither " + default_address.text() + " nor port " +
            std::to_string(settings.http_port) +
            " answers HTTP; start Haply's Inverse service 3.5 or later, or correct inverse3.host, "
            "inverse3.port and inverse3.http_port";
  } catch (const NoService& no_service) {
    error = no_service.what();
  }
  if (auto older = find_older_service(settings, timeout)) return *older;
  throw DeviceError(one_line(error));
}

std::string ids_of(const std::vector<DeviceReport>& devices) {
  std::string ids;
  for (const DeviceReport& device : devices) ids += (ids.empty() ? "" : ", ") + device.id;
  return ids;
}

const DeviceReport* find_device(const ServiceReport& report, const std::string& id) {
  const auto found = std::find_if(report.devices.begin(), report.devices.end(),
                                  [&](const DeviceReport& device) { return device.id == id; });
  return found == report.devices.end() ? nullptr : &*found;
}

DeviceReadiness readiness_of(const ArmStatus& status) noexcept {
  if (status.is_usable()) return DeviceReadiness::ready;
  return status.calibrated ? DeviceReadiness::needs_calibration : DeviceReadiness::needs_inkwell;
}

/// \return why the configuration is unsuitable, and the remedy; empty if suitable
std::string configuration_fault(const DeviceConfig& config) {
  const std::string remedy = "; reset it for the profile touchtrial in Haply Hub, or close the Hub";
  if (!config.force_gate || !config.damping) {
    return "the service does not report its force gate and damping, which alter textures; update "
           "it";
  }
  if (*config.force_gate != 0.0) {
    return "the service's force gate stays at " + number_text(*config.force_gate) +
           ", which alters textures" + remedy;
  }
  if (*config.damping != 0.0) {
    return "the service's damping stays at " + number_text(*config.damping) +
           ", which alters textures" + remedy;
  }
  if (config.preset != kCentredPreset) {
    return "the service's preset stays " + config.preset + " instead of " + kCentredPreset + remedy;
  }
  if (!config.plain_frame) return "the service rotates or scales positions and forces" + remedy;
  return "";
}

std::string on_off_text(const std::optional<bool>& setting) {
  if (!setting) return "not reported";
  return *setting ? "on" : "off";
}

/// The service's processing of forces, which a session records as firmware.
std::string firmware_text(const DeviceConfig& config, const ServiceVersion& version) {
  std::string text = config.firmware.empty() ? "" : config.firmware + ", ";
  text += "service " + version.text();
  if (!config.handedness.empty()) text += ", " + config.handedness + "-handed";
  if (config.force_gate) text += ", force gate " + number_text(*config.force_gate);
  if (config.damping) text += ", damping " + number_text(*config.damping);
  text += ", torque scaling " + on_off_text(config.torque_scaling);
  if (config.gravity_compensation) {
    text += ", gravity compensation " + number_text(*config.gravity_compensation);
  }
  text += ", home return " + on_off_text(config.home_return);
  return one_line(text);
}

std::vector<std::string> required_actions(const ArmStatus& status) {
  std::vector<std::string> actions;
  if (!status.power_supply) actions.push_back("it has no power; connect its power supply");
  if (!status.calibrated) {
    actions.push_back(
        "it is not calibrated; put the grip into its inkwell until its light changes");
  }
  return actions;
}

std::vector<DeviceListing> list_inverse3(const DeviceSettings& settings) {
  const Inverse3Settings& inverse3_settings = settings.inverse3;
  DeviceListing listing_template{"inverse3", "", "", address_of(inverse3_settings).text(),
                                 false,      {}};
  try {
    const ServiceInfo service = find_service(inverse3_settings, kListTimeout);
    const ServiceReport inventory =
        parse_report(required_answer(service.http, "/devices", kListTimeout));
    std::vector<DeviceListing> listings;
    for (const DeviceReport& device : inventory.devices) {
      DeviceListing listing = listing_template;
      listing.model = model_of(device.config ? device.config->type : "inverse3");
      listing.serial = one_line(device.id);
      listing.where += ", service " + service.version.text();
      listing.present = true;
      if (device.status) listing.missing = required_actions(*device.status);
      listings.push_back(std::move(listing));
    }
    if (!listings.empty()) return listings;
    listing_template.missing = {"the service has no Inverse3; plug it in and switch it on"};
  } catch (const DeviceError& error) {
    listing_template.missing = {error.what()};
  } catch (const BadMessage& error) {
    listing_template.missing = {one_line("inverse3: the list of devices is invalid (" +
                                         std::string(error.what()) + "); update the service")};
  }
  return {listing_template};
}

std::unique_ptr<HapticDevice> open_inverse3(const DeviceSettings& settings) {
  return std::make_unique<Inverse3Device>(settings.inverse3);
}

}  // namespace

Inverse3Device::Inverse3Device(const Inverse3Settings& settings, Inverse3Options options)
    : settings_(settings),
      options_(std::move(options)),
      service_info_(find_service(settings_, options_.timeout)) {
  service_ = std::make_unique<ServiceLink>(address_of(settings_), options_.timeout);
  try {
    const ServiceReport inventory = parse_report(service_->answer());
    choose_device(inventory);
    expect_no_other_session(inventory);
    configure();
  } catch (const BadMessage& error) {
    refuse_message(address_of(settings_), "a message", error);
  }
  thread_ = std::thread([this] {
    (void)request_scheduling(options_.scheduling);
    started_.count_down();
    exchange_until_stopped();
  });
  started_.wait();
}

Inverse3Device::~Inverse3Device() {
  stopping_.store(true, std::memory_order_release);
  options_.pace->end();
  thread_.join();
}

void Inverse3Device::choose_device(const ServiceReport& inventory) {
  const std::vector<DeviceReport>& devices = inventory.devices;
  if (devices.empty()) {
    throw DeviceError("inverse3: the service has no Inverse3; plug it in and switch it on");
  }
  if (settings_.device_id.empty() && devices.size() > 1) {
    throw DeviceError(one_line("inverse3: the service has several devices (" + ids_of(devices) +
                               "); set inverse3.device_id in the device settings"));
  }
  id_ = settings_.device_id.empty() ? devices.front().id : settings_.device_id;
  const DeviceReport* const device = find_device(inventory, id_);
  if (device == nullptr) {
    throw DeviceError(one_line("inverse3: there is no device " + id_ + " (connected: " +
                               ids_of(devices) + "); correct inverse3.device_id"));
  }
  if (!device->status) throw BadMessage("no status");
  if (!device->status->power_supply) {
    throw DeviceError(one_line("inverse3: " + id_ + " has no power; connect its power supply"));
  }
  session_id_ = inventory.session_id;
  centre_m_ = service_info_.version.has_filters() ? Vec3{} : kCentreInBaseFrameM;
  update_status(*device->status);
  describe(device->config.value_or(DeviceConfig{}));
}

/// Forces of several sessions would add up and exceed the safety limits.
void Inverse3Device::expect_no_other_session(const ServiceReport& inventory) const {
  const std::string remedy =
      "; forces of several programs would add up; close the others, including Haply Hub";
  if (!service_info_.version.has_filters()) {
    const auto& status = find_device(inventory, id_)->status;
    if (!status->in_use) return;
    throw DeviceError(one_line("inverse3: another program uses " + id_ + remedy));
  }
  const std::vector<std::string> sessions =
      parse_sessions(required_answer(service_info_.http, "/sessions", options_.timeout));
  if (sessions.size() <= 1) return;
  std::string names;
  for (const std::string& name : sessions) {
    if (!name.empty()) names += (names.empty() ? "" : ", ") + name;
  }
  throw DeviceError(one_line("inverse3: another session is connected to the service" +
                             (names.empty() ? "" : " (" + names + ")") + remedy));
}

DeviceReport Inverse3Device::exchange_configuration(const std::string& message) {
  if (service_->exchange(message, options_.timeout) != LinkOutcome::ok) {
    throw DeviceError(one_line("inverse3: the service at " + address_of(settings_).text() +
                               " does not answer its configuration; restart it"));
  }
  const ServiceReport report = parse_report(service_->answer());
  const DeviceReport* const device = find_device(report, id_);
  if (device == nullptr) throw BadMessage("the device has disappeared");
  return *device;
}

void Inverse3Device::configure() {
  DeviceReport device = exchange_configuration(first_message(service_info_.version, id_));
  if (service_info_.version.has_filters()) {
    std::string problem = "the service does not report its configuration; update it";
    for (int i = 0; i < kMaxReadBacks && !problem.empty(); ++i) {
      if (i > 0) std::this_thread::sleep_for(kReadBackInterval);
      device = exchange_configuration(inventory_request(service_info_.version, id_));
      if (device.config) problem = configuration_fault(*device.config);
    }
    if (!problem.empty()) throw DeviceError(one_line("inverse3: " + problem));
  }
  if (device.config) {
    refuse_home_return(*device.config);
    describe(*device.config);
  }
  if (device.status) update_status(*device.status);
  listen_to_events();
}

/// Home return is a setting of the device, not of the session, so the driver does not change it.
void Inverse3Device::refuse_home_return(DeviceConfig& config) const {
  const std::string path = "/inverse3/" + id_ + "/config/home_return";
  if (!config.home_return) {
    const HttpAnswer answer = query_service(service_info_.http, path, options_.timeout);
    if (answer.status == 200) config.home_return = parse_home_return(answer.body);
  }
  if (!config.home_return.value_or(false)) return;
  throw DeviceError(
      one_line("inverse3: the arm's home return is on, which moves the hand; "
               "switch it off in Haply Hub, or over HTTP at " +
               service_info_.http.text() + path));
}

/// Services before 3.5 may lack the channel.
void Inverse3Device::listen_to_events() try {
  service_->listen_to({settings_.host, settings_.events_port}, options_.timeout);
} catch (const DeviceError&) {
  if (!service_info_.version.has_filters()) return;
  throw DeviceError(one_line(
      "inverse3: the service's events, which report its emergency brake, cannot be received at " +
      settings_.host + ':' + std::to_string(settings_.events_port) +
      "; correct inverse3.events_port"));
}

void Inverse3Device::describe(const DeviceConfig& config) {
  info_.name = "inverse3";
  info_.serial = one_line(id_);
  info_.model = model_of(config.type);
  info_.firmware = firmware_text(config, service_info_.version);
  info_.max_force_n = settings_.max_force_n;
  info_.max_rate_hz = kRateHz;
  info_.has_encoders = true;
  const double radius_mm = config.type == "minverse" ? kMinverseRadiusMm : kInverse3RadiusMm;
  const Vec3 reach_mm = {radius_mm, radius_mm, radius_mm};
  info_.workspace = Workspace{-1.0 * reach_mm, reach_mm, WorkspaceShape::ellipsoid};
}

void Inverse3Device::exchange_until_stopped() noexcept {
  LinkPace::Time next = options_.pace->now();
  while (!stopping_.load(std::memory_order_acquire) && link_.fault() == DeviceFault::none) {
    options_.pace->rest_until(next);
    next = options_.pace->now() + kPeriod;
    try {
      exchange();
    } catch (const BadMessage&) {
      link_.fail(DeviceFault::bad_data);
    } catch (const std::exception&) {
      link_.fail(DeviceFault::driver);
    }
  }
  send_final_zeros();
  options_.pace->end();
}

void Inverse3Device::exchange() {
  // Read even if not sent, so that no old force remains in the link.
  const Vec3 requested_n = link_.force_to_send(options_.pace->now());
  const bool is_allowed = status_.is_usable() && is_finite(requested_n);
  const Vec3 sent_n = is_allowed ? limit_to_max_force(requested_n) : Vec3{};
  switch (service_->exchange(force_message(service_info_.version, id_, to_service_axes(sent_n)),
                             options_.answer_timeout)) {
    case LinkOutcome::ok:
      break;
    case LinkOutcome::nonsense:
      return link_.fail(DeviceFault::bad_data);
    case LinkOutcome::silent:
    case LinkOutcome::closed:
      return link_.fail(DeviceFault::link_lost);
  }
  for (const std::string& event : service_->take_events()) handle_event(parse_event(event));
  if (service_->events_ended()) return link_.fail(DeviceFault::link_lost);
  const ServiceReport report = parse_report(service_->answer());
  const DeviceReport* const device = find_device(report, id_);
  if (device == nullptr) return link_.fail(DeviceFault::link_lost);
  publish_sample(*device, report.buttons);
}

void Inverse3Device::publish_sample(const DeviceReport& report, std::uint32_t buttons) noexcept {
  const Vec3 position_m = report.position_m - centre_m_;
  if (norm(position_m) > kMaxM) return link_.fail(DeviceFault::bad_data);
  if (report.status) update_status(*report.status);
  DeviceSample sample;
  sample.position_mm = kMmPerM * to_device_axes(position_m);
  sample.velocity_mm_s = kMmPerM * to_device_axes(report.velocity_m_s);
  sample.buttons = buttons;
  sample.ready = status_.is_usable();
  if (report.delivered_n) sample.delivered_n = to_device_axes(*report.delivered_n);
  link_.publish(sample);
}

void Inverse3Device::update_status(const ArmStatus& status) noexcept {
  status_ = status;
  readiness_.store(readiness_of(status), std::memory_order_release);
}

void Inverse3Device::handle_event(const ServiceEvent& event) noexcept {
  const bool is_other_session = event.category == "session" && event.session_id && session_id_ &&
                                *event.session_id != *session_id_;
  if (is_other_session) return link_.fail(DeviceFault::driver);
  if (!event.device_id.empty() && event.device_id != id_) return;
  if (event.name == "device-disconnected") link_.fail(DeviceFault::link_lost);
  if (event.name == "device-busy") link_.fail(DeviceFault::driver);
  const bool is_safety_stop = event.safety_type == "ebrake_triggered" ||
                              event.safety_type == "stall_detected" ||
                              event.safety_type == "stability_ceiling";
  if (event.name == "device-safety-triggered" && is_safety_stop)
    link_.fail(DeviceFault::limit_passed);
}

void Inverse3Device::send_final_zeros() noexcept {
  try {
    const std::string no_force = force_message(service_info_.version, id_, {});
    // Waits for answers, because closing may lose messages in transit.
    bool has_answers = true;
    for (int i = 0; i < kFinalPackets; ++i) {
      if (has_answers) {
        has_answers = service_->exchange(no_force, options_.answer_timeout) == LinkOutcome::ok;
      } else {
        service_->post(no_force, kFinalTimeout);
      }
    }
  } catch (const std::exception&) {
    // Without messages the arm becomes idle.
  }
  service_->close(kFinalTimeout);
}

Vec3 Inverse3Device::limit_to_max_force(Vec3 force_n) const noexcept {
  const double max_axis_n =
      std::max({std::abs(force_n.x), std::abs(force_n.y), std::abs(force_n.z)});
  const double limit_n = settings_.max_force_n;
  return max_axis_n > limit_n ? (limit_n / max_axis_n) * force_n : force_n;
}

}  // namespace touchtrial::device::inverse3

namespace touchtrial::device {

/// Sources of unverified facts: this driver's page in docs/devices.
DeviceDriver inverse3_driver() {
  return {
      .name = "inverse3",
      .what = "Haply Inverse3 and Minverse, through Haply's Inverse service",
      .list = inverse3::list_inverse3,
      .open = inverse3::open_inverse3,
      .workspace_is_known = false,
      .products = {{"inverse3", "Haply Inverse3", "inverse3"},
                   {"inverse3x", "Haply Inverse3x"},
                   {"minverse", "Haply Minverse"}},
      .unverified = {
          {"signs", "the signs of positions and forces on each axis"},
          {"ports", "whether HTTP, simulation and events answer at the configured ports"},
          {"filters", "whether force gate and damping stay at 0 after they are read back"},
          {"torque_scaling", "the effect of torque scaling on a force within the limits"},
          {"lengths", "whether the service's millimetre is a millimetre at the handle"},
          {"middle", "the centre of the workspace in the device's frame"},
          {"delivered", "whether the force that the service reports is the commanded one"},
          {"readings", "the rate of new states"},
          {"program_silent", "whether and how soon the arm becomes idle when messages stop"},
          {"cable_silent", "the arm's behaviour when its cable is pulled"},
          {"service_killed", "the arm's behaviour when the service is killed"},
          {"peak_force",
           "the maximum and the continuous force; neither is published (device accept --thermal)"},
          {"latency", "the latency of service, USB and motors (device accept, step shake)"},
          {"home_return",
           "the form of the service's answer about home_return",
           "Does touchtrial device list or the service report that home return is off?",
           {"off", "on", "not_told"}},
          {"sessions",
           "the form of the events about sessions, and whether a session that begins later is "
           "detected"},
          {"in_use",
           "whether in_use is true for the program's own session (services before 3.5)"}}};
}

}  // namespace touchtrial::device
