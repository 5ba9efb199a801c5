// extract: computes the texture of one image, and optionally writes every stage.
#include "app/commands/commands.hpp"
#include "app/commands/input_pictures.hpp"
#include "app/commands/method_arguments.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/npy.hpp"
#include "core/outputs.hpp"
#include "engine/extraction.hpp"
#include "engine/force_field.hpp"
#include "engine/image_file.hpp"
#include "engine/metrics/picture_statistics.hpp"
#include "engine/pictures/force_arrows.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

/// The neighbourhood of the forces that the engine computes together with a texture.
constexpr int kForceNeighbourhood = 3;

struct ExtractArguments {
  fs::path image;
  engine::SampleScale scale;
  MethodArguments method;
  std::string mapping = "offset";
  int neighbourhood = 3;
  std::string precision = "float";
  fs::path output;
  fs::path arrows;
  fs::path dump;
};

/// Writes a plane and frees it, because the planes of a large picture fill most of the memory.
template <typename Real>
void dump_if_computed(const fs::path& folder, const std::string& name, Plane<Real>& plane) {
  if (!plane.empty()) write_npy(folder / (name + ".npy"), plane);
  plane = {};
}

/// Writes an array (H, W, 2): the force's x, then y, at each pixel.
template <typename Real>
void dump_force(const fs::path& folder, const engine::ForceField<Real>& force) {
  std::vector<Real> interleaved;
  interleaved.reserve(2 * force.x.size());
  for (std::size_t i = 0; i < force.x.size(); ++i) {
    interleaved.push_back(force.x.samples()[i]);
    interleaved.push_back(force.y.samples()[i]);
  }
  write_npy<Real>(folder / "force_tangential.npy", interleaved,
                  {force.x.height(), force.x.width(), 2});
}

/// Checks the paths of all planes that a method may produce, before the extraction starts.
void require_dump_places(const fs::path& folder) {
  for (const char* name :
       {"image", "subband_LL", "subband_LH", "subband_HL", "subband_HH", "csgv", "order",
        "enhanced", "cartoon", "texture", "texture_u8", "force_tangential"}) {
    require_output_path(folder / (std::string(name) + ".npy"));
  }
}

/// Writes all planes, and frees all except texture, picture and force.
template <typename Real>
void dump_all(const fs::path& folder, GreyImage& image, engine::Extraction<Real>& extraction) {
  make_folder(folder);
  dump_if_computed(folder, "image", image);
  dump_if_computed(folder, "subband_LL", extraction.sub_band_ll);
  dump_if_computed(folder, "subband_LH", extraction.sub_band_lh);
  dump_if_computed(folder, "subband_HL", extraction.sub_band_hl);
  dump_if_computed(folder, "subband_HH", extraction.sub_band_hh);
  dump_if_computed(folder, "csgv", extraction.csgv);
  dump_if_computed(folder, "order", extraction.order);
  dump_if_computed(folder, "enhanced", extraction.enhanced);
  dump_if_computed(folder, "cartoon", extraction.cartoon);
  write_npy(folder / "texture.npy", extraction.texture);
  write_npy(folder / "texture_u8.npy", extraction.picture);
  dump_force(folder, extraction.force);
}

/// \return a line about the picture
template <typename Real>
std::string draw_arrows(const fs::path& path, const engine::Extraction<Real>& extraction) {
  const engine::ArrowPatch patch = engine::write_force_arrows(
      path, extraction.picture,
      {converted<double>(extraction.force.x), converted<double>(extraction.force.y)});
  return fmt::format(
      "{}: {} x {} px from ({}, {}); an arrow one pixel long stands for {:.3g} grey levels per "
      "pixel\n",
      path.string(), patch.width, patch.height, patch.x, patch.y, patch.force_of_unit_arrow);
}

template <typename Real>
std::string summary(const ExtractArguments& arguments, const engine::Extraction<Real>& extraction) {
  const GreyImage& picture = extraction.picture;
  const auto samples = extraction.texture.samples();
  const auto [low, high] = std::minmax_element(samples.begin(), samples.end());
  std::string text = fmt::format(
      "{}: {} x {} px, {}, texture {:.3f} to {:.3f} grey levels, entropy {:.4f} nats\n",
      arguments.image.string(), picture.width(), picture.height(), arguments.method.method,
      static_cast<double>(*low), static_cast<double>(*high), engine::entropy(picture));
  if (arguments.method.components == "auto" && !extraction.components.empty()) {
    const engine::GaborComponent& strongest = extraction.components.front();
    text += fmt::format("component: {:.4f} cycles per pixel at {:.1f} degrees\n",
                        strongest.frequency_cycles_per_px, strongest.direction_deg);
  }
  return text;
}

/// \throws FileError with the image's name if it is too small for an option, for instance "auto"
template <typename Real>
engine::Extraction<Real> run_extraction(const fs::path& path, const GreyImage& image,
                                        const engine::ExtractionOptions& options,
                                        const engine::RequestedPlanes& requested) {
  try {
    return engine::extract_texture<Real>(image, options, requested);
  } catch (const std::invalid_argument& error) {
    throw FileError(one_line(path.string()) + ": " + error.what() +
                    "; list them, or give a larger image");
  }
}

engine::RequestedPlanes requested_planes(const ExtractArguments& arguments) {
  engine::RequestedPlanes requested =
      arguments.dump.empty() ? engine::RequestedPlanes{} : engine::RequestedPlanes::all();
  requested.picture = arguments.mapping == engine::kMappingNames.front().name;
  requested.force = arguments.neighbourhood == kForceNeighbourhood &&
                    (!arguments.dump.empty() || !arguments.arrows.empty());
  return requested;
}

/// Computes the picture and the force for mappings and neighbourhoods that the engine does not
/// provide together with a texture.
template <typename Real>
void compute_missing(const ExtractArguments& arguments, engine::Extraction<Real>& extraction) {
  if (extraction.picture.empty()) {
    extraction.picture = engine::texture_picture(
        extraction.texture, *value_in(engine::kMappingNames, arguments.mapping));
  }
  const bool needs_force = !arguments.dump.empty() || !arguments.arrows.empty();
  if (needs_force && extraction.force.x.empty()) {
    extraction.force = engine::tangential_force(extraction.texture, arguments.neighbourhood);
  }
}

template <typename Real>
int extract_with(const ExtractArguments& arguments, const engine::ExtractionOptions& options) {
  GreyImage image = read_input_picture(arguments.image, arguments.scale);
  engine::Extraction<Real> extraction =
      run_extraction<Real>(arguments.image, image, options, requested_planes(arguments));
  if (!extraction.converged) {
    spdlog::warn("{}: tv-gabor stopped after {} steps with a relative gap of {:.2g}",
                 arguments.image.string(), extraction.steps, extraction.gap);
  }
  compute_missing(arguments, extraction);
  if (!arguments.output.empty()) engine::write_png(arguments.output, extraction.picture);
  if (!arguments.dump.empty()) dump_all(arguments.dump, image, extraction);
  std::string text = summary(arguments, extraction);
  if (!arguments.arrows.empty()) text += draw_arrows(arguments.arrows, extraction);
  print(text);
  return 0;
}

/// Refuses an output that is not a PNG, is the input, or would overwrite a foreign file.
void check_output(const fs::path& image, const fs::path& output, const std::string& option) {
  if (output.empty()) return;
  std::error_code ignored;
  if (fs::equivalent(image, output, ignored)) {
    throw UsageError("extract: " + output.string() + " is the input picture; give another " +
                     option);
  }
  if (ending_of(output) != ".png") {
    throw UsageError("extract: " + output.string() +
                     ": pictures are written as PNG; give a name that ends in .png");
  }
  require_output_path(output);
}

int extract(const ExtractArguments& arguments) {
  check_output(arguments.image, arguments.output, "-o");
  check_output(arguments.image, arguments.arrows, "--arrows");
  if (!arguments.dump.empty()) require_dump_places(arguments.dump);
  const engine::ExtractionOptions options = extraction_options(arguments.method);
  if (!arguments.arrows.empty() &&
      arguments.arrows.lexically_normal() == arguments.output.lexically_normal()) {
    throw UsageError("extract: --output and --arrows name the same file; give two names");
  }
  if (arguments.neighbourhood % 2 == 0) {
    throw UsageError("extract: --neighbourhood is a side length and must be odd, 3 or more");
  }
  return arguments.precision == "double" ? extract_with<double>(arguments, options)
                                         : extract_with<float>(arguments, options);
}

}  // namespace

void add_extract_command(CLI::App& program, Action& action) {
  const auto [command, arguments] =
      add_command(program, action, "extract", "Extract the texture of one image", extract);
  command.add_option("IMAGE", arguments.image, "PNG, JPEG, TIFF, BMP, GIF or PGM")->required();
  add_sample_options(command, arguments.scale);
  add_method_options(command, arguments.method);
  command.add_option("--mapping", arguments.mapping, "Mapping of the texture to a picture")
      ->check(CLI::IsMember(words_of(engine::kMappingNames)))
      ->capture_default_str();
  add_count_option(command, "--neighbourhood", arguments.neighbourhood,
                   "Side n of the force's neighbourhood, odd", 3, 1001);
  command.add_option("-o,--output", arguments.output, "Write the texture as an 8-bit PNG");
  command.add_option("--arrows", arguments.arrows,
                     "Draw the force field over an enlarged patch, as PNG");
  command.add_option("--dump", arguments.dump, "Write every stage as .npy files into this folder");
  add_force_flag(command);
  command.add_option("--precision", arguments.precision, "Precision of the extraction")
      ->check(CLI::IsMember({"float", "double"}))
      ->capture_default_str();
}

}  // namespace touchtrial::app
