#include "app/touchtrial_process.hpp"
#include "core/files.hpp"
#include "core/random.hpp"
#include "core/version.hpp"
#include "engine/image_file.hpp"
#include "support/catch.hpp"
#include "support/npy_array.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::engine;

namespace {

GreyImage noise(int height, int width) {
  RandomStream random(1, "extract test");
  GreyImage image(height, width);
  for (std::uint8_t& sample : image.samples())
    sample = static_cast<std::uint8_t>(random.below(256));
  return image;
}

}  // namespace

TEST_CASE("extract writes the texture and every stage, with consistent shapes and values") {
  const TempFolder folder;
  const auto path = folder.path() / "noise.png";
  write_png(path, noise(21, 34));
  const auto dump = folder.path() / "dump";
  const ProgramResult result = run_touchtrial(
      folder.path(), {"extract", path.string(), "--dump", dump.string(), "-o",
                      (folder.path() / "out.png").string(), "--precision", "double"});
  INFO(result.errors);
  REQUIRE(result.exit_code == 0);
  CHECK(line_count(result.output) == 1);
  CHECK(result.errors.empty());

  CHECK(read_npy(dump / "image.npy").shape == std::vector<int>{21, 34});
  CHECK(read_npy(dump / "subband_LH.npy").shape == std::vector<int>{11, 17});
  CHECK(read_npy(dump / "force_tangential.npy").shape == std::vector<int>{21, 34, 2});
  CHECK(read_npy(dump / "order.npy").type == "<f8");
  const auto image = read_npy(dump / "image.npy").samples;
  const auto texture = read_npy(dump / "texture.npy").samples;
  const auto enhanced = read_npy(dump / "enhanced.npy").samples;
  const auto rounded = read_npy(dump / "texture_u8.npy").samples;
  const GreyImage written = read_grey_image(folder.path() / "out.png");
  for (std::size_t i = 0; i < texture.size(); ++i) {
    CHECK(enhanced[i] == Approx(image[i] + texture[i]));
    CHECK(rounded[i] == std::min(255.0, std::max(0.0, std::floor(128 + texture[i] + 0.5))));
    CHECK(written.samples()[i] == rounded[i]);
  }
}

TEST_CASE("extract dumps single precision unless double is requested") {
  const TempFolder folder;
  const auto path = folder.path() / "noise.png";
  write_png(path, noise(5, 7));
  for (const std::string method : {"adaptive", "tv-gabor"}) {
    const auto dump = folder.path() / method;
    REQUIRE(run_touchtrial(folder.path(),
                           {"extract", path.string(), "--method", method, "--dump", dump.string()})
                .exit_code == 0);
    CHECK(read_npy(dump / "texture.npy").type == "<f4");
  }
  CHECK(std::filesystem::exists(folder.path() / "tv-gabor" / "cartoon.npy"));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "tv-gabor" / "order.npy"));
}

TEST_CASE("extract extracts the texture by every method and option") {
  const TempFolder folder;
  const auto path = (folder.path() / "noise.png").string();
  write_png(path, noise(12, 17));
  const std::vector<std::vector<std::string>> variants = {
      {"--method", "fixed", "--order", "0.9", "--norm", "sum", "--radius", "40"},
      {"--norm", "none", "--mapping", "stretch", "--gradient", "prewitt", "--combine", "max"},
      {"--levels", "3", "--gradient", "central", "--combine", "l2", "--mapping", "abs"},
      {"--method", "gaussian", "--sigma", "1.5"},
      {"--method", "median", "--radius", "1", "--threshold", "0"},
      {"--method", "edge", "--divisor", "2"},
      {"--method", "luminance", "--precision", "double"},
      {"--method", "edge", "--control", "phase-scrambled", "--seed", "7"},
      {"--method", "tv-gabor", "--components", "0.2,0;0.3,-45.5"}};
  for (const auto& variant : variants) {
    std::vector<std::string> arguments = {"extract", path};
    arguments.insert(arguments.end(), variant.begin(), variant.end());
    const ProgramResult result = run_touchtrial(folder.path(), arguments);
    INFO(Catch::rangeToString(arguments) << " " << result.errors);
    CHECK(result.exit_code == 0);
    CHECK(line_count(result.output) == 1);
  }
}

TEST_CASE("extract says which component auto chose, or why there is none") {
  const TempFolder folder;
  const auto path = (folder.path() / "noise.png").string();
  const std::vector<std::string> arguments = {"extract",  path,           "--method",
                                              "tv-gabor", "--components", "auto"};
  write_png(path, noise(12, 17));
  CHECK_THAT(run_touchtrial(folder.path(), arguments).output, holds_text("component: 0."));
  write_png(path, noise(2, 2));
  const ProgramResult result = run_touchtrial(folder.path(), arguments);
  CHECK(result.exit_code == 1);
  CHECK(line_count(result.errors) == 1);
  CHECK_THAT(result.errors, holds_text("noise.png: components: auto needs an image"));
}

TEST_CASE("extract applies the mapping to the picture, and never to the forces") {
  const TempFolder folder;
  const auto path = (folder.path() / "noise.png").string();
  write_png(path, noise(12, 17));
  for (const std::string mapping : {"offset", "stretch"}) {
    const auto dump = (folder.path() / mapping).string();
    REQUIRE(run_touchtrial(folder.path(), {"extract", path, "--mapping", mapping, "--dump", dump})
                .exit_code == 0);
  }
  const auto plane = [&](const char* mapping, const char* name) {
    return read_npy(folder.path() / mapping / name).samples;
  };
  const std::vector<double> picture = plane("stretch", "texture_u8.npy");
  CHECK(*std::min_element(picture.begin(), picture.end()) == 0.0);
  CHECK(*std::max_element(picture.begin(), picture.end()) == 255.0);
  CHECK(plane("offset", "force_tangential.npy") == plane("stretch", "force_tangential.npy"));
}

TEST_CASE("extract dumps the control's texture, picture and force, and the method's orders") {
  const TempFolder folder;
  const auto path = (folder.path() / "noise.png").string();
  write_png(path, noise(12, 17));
  const auto dumped = [&](const std::string& name, const std::vector<std::string>& options) {
    const auto dump = folder.path() / name;
    std::vector<std::string> arguments = {"extract", path, "--dump", dump.string()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    REQUIRE(run_touchtrial(folder.path(), arguments).exit_code == 0);
    return dump;
  };
  const auto plain = dumped("plain", {});
  const auto control = dumped("control", {"--control", "phase-scrambled", "--seed", "3"});
  const auto again = dumped("again", {"--control", "phase-scrambled", "--seed", "3"});
  const auto wide = dumped("wide", {"--neighbourhood", "5"});
  for (const char* name : {"texture.npy", "texture_u8.npy", "force_tangential.npy"}) {
    INFO(name);
    CHECK(read_file(control / name) != read_file(plain / name));
    CHECK(read_file(control / name) == read_file(again / name));
  }
  CHECK(read_file(control / "order.npy") == read_file(plain / "order.npy"));
  CHECK(read_file(wide / "texture.npy") == read_file(plain / "texture.npy"));
  CHECK(read_file(wide / "force_tangential.npy") != read_file(plain / "force_tangential.npy"));
}

TEST_CASE("extract draws the force field over an enlarged patch") {
  const TempFolder folder;
  const auto path = folder.path() / "noise.png";
  write_png(path, noise(40, 50));
  const auto arrows = folder.path() / "arrows.png";
  const ProgramResult result =
      run_touchtrial(folder.path(), {"extract", path.string(), "--arrows", arrows.string()});
  INFO(result.errors);
  REQUIRE(result.exit_code == 0);
  CHECK(line_count(result.output) == 2);
  CHECK(read_grey_image(arrows).height() == 720);
}

TEST_CASE("extract says that an order of 1 is outside the range") {
  const TempFolder folder;
  const auto path = (folder.path() / "noise.png").string();
  write_png(path, noise(5, 7));
  const ProgramResult result =
      run_touchtrial(folder.path(), {"extract", path, "--method", "fixed", "--order", "1"});
  CHECK(result.errors == "touchtrial: extract: --order: must be in [0, 1), not 1\n");
}

TEST_CASE("extract refuses bad arguments with exit 2 and one line") {
  const TempFolder folder;
  const auto path = (folder.path() / "noise.png").string();
  write_png(path, noise(5, 7));
  const std::vector<std::vector<std::string>> bad = {
      {"extract"},
      {"extract", path, "--method", "magic"},
      {"extract", path, "--method", "fixed"},
      {"extract", path, "--method", "fixed", "--order", "1"},
      {"extract", path, "--method", "fixed", "--order", "-0.1"},
      {"extract", path, "--method", "fixed", "--order", "nan"},
      {"extract", path, "--order", "0.5"},
      {"extract", path, "--norm", "max"},
      {"extract", path, "--levels", "9"},
      {"extract", path, "--sigma", "2"},
      {"extract", path, "--components", "auto"},
      {"extract", path, "--method", "gaussian", "--sigma", "0"},
      {"extract", path, "--method", "gaussian", "--sigma", "1001"},
      {"extract", path, "--method", "gaussian", "--norm", "sum"},
      {"extract", path, "--method", "edge", "--divisor", "nan"},
      {"extract", path, "--method", "tv-gabor", "--mapping", "square"},
      {"extract", path, "--method", "tv-gabor", "--components", "0.2"},
      {"extract", path, "--method", "tv-gabor", "--components", "0.6,0"},
      {"extract", path, "--method", "tv-gabor", "--components", "0.2,nan"},
      {"extract", path, "--method", "tv-gabor", "--components", "0.2,0;"},
      {"extract", path, "--method", "tv-gabor", "--components", ""},
      {"extract", path, "--radius", "0"},
      {"extract", path, "--radius", "64"},
      {"extract", path, "--neighbourhood", "4"},
      {"extract", path, "--precision", "half"},
      {"extract", path, "--control", "scrambled"},
      {"extract", path, "--control", "phase-scrambled", "--seed", "-1"},
      {"extract", path, "--seed", "7"},
      {"extract", path, "--no-such-option"},
      {"no-such-command"},
      {},
  };
  for (const auto& arguments : bad) {
    const ProgramResult result = run_touchtrial(folder.path(), arguments);
    INFO(Catch::rangeToString(arguments) << " " << result.errors);
    CHECK(result.exit_code == 2);
    CHECK(line_count(result.errors) == 1);
    CHECK(result.output.empty());
  }
}

TEST_CASE("extract refuses a file that is not an image with exit 1, one line and its name") {
  const TempFolder folder;
  const auto text = folder.path() / "text.png";
  replace_file(text, "this is no picture");
  for (const std::string name : {"text.png", "missing.png"}) {
    const ProgramResult result =
        run_touchtrial(folder.path(), {"extract", (folder.path() / name).string()});
    CHECK(result.exit_code == 1);
    CHECK(line_count(result.errors) == 1);
    CHECK(result.errors.find(name) != std::string::npos);
  }
}

TEST_CASE("extract never writes over its picture, and writes PNG only") {
  const TempFolder folder;
  const auto path = (folder.path() / "noise.png").string();
  write_png(path, noise(5, 7));
  const Bytes before = read_file(path);
  CHECK(run_touchtrial(folder.path(), {"extract", path, "-o", path}).exit_code == 2);
  CHECK(read_file(path) == before);
  const std::string jpeg = (folder.path() / "out.jpg").string();
  CHECK(run_touchtrial(folder.path(), {"extract", path, "-o", jpeg}).exit_code == 2);
  CHECK_FALSE(std::filesystem::exists(jpeg));
}

TEST_CASE("extract says which file it cannot write") {
  const TempFolder folder;
  const auto path = (folder.path() / "noise.png").string();
  write_png(path, noise(5, 7));
  const ProgramResult result =
      run_touchtrial(folder.path(), {"extract", path, "-o", "/no/such/folder/out.png"});
  CHECK(result.exit_code == 1);
  CHECK(line_count(result.errors) == 1);
  CHECK(result.errors.find("/no/such/folder/out.png") != std::string::npos);
}

TEST_CASE("every command has help of 80 columns, in two ways") {
  const TempFolder folder;
  const ProgramResult version = run_touchtrial(folder.path(), {"--version"});
  CHECK(version.exit_code == 0);
  CHECK(version.output.starts_with("touchtrial " + std::string(program_version())));
  std::vector<std::string> commands = {""};
  std::istringstream table(run_touchtrial(folder.path(), {"reference", "--table"}).output);
  for (std::string row; std::getline(table, row);) {
    const std::string words = row.substr(0, row.find("|-|"));
    const std::size_t bar = words.find('|');
    if (words == row || words[bar + 1] == '-') continue;
    commands.push_back(words.substr(0, bar) + (bar == 0 ? "" : " ") + words.substr(bar + 1));
  }
  CHECK(commands.size() > 40);
  for (const std::string& command : commands) {
    INFO(command);
    const ProgramResult help = run_touchtrial(
        folder.path(), typed_words(command + (command.empty() ? "" : " ") + "--help", {}));
    CHECK(help.exit_code == 0);
    CHECK_THAT(help.output, holds_text("Usage: touchtrial " + command));
    CHECK(run_touchtrial(folder.path(), typed_words("help " + command, {})).output == help.output);
    std::istringstream lines(help.output);
    for (std::string line; std::getline(lines, line);) CHECK(line.size() <= 80);
  }
}

TEST_CASE("a bad argument points to the help of its own command") {
  const TempFolder folder;
  const auto errors_of = [&](const std::vector<std::string>& arguments) {
    return run_touchtrial(folder.path(), arguments).errors;
  };
  CHECK_THAT(errors_of({"extract"}), holds_text("see touchtrial extract --help"));
  CHECK_THAT(errors_of({"stimuli", "import", "--crops", "x"}),
             holds_text("see touchtrial stimuli import --help"));
  CHECK_THAT(errors_of({"--no-such-option"}), holds_text("see touchtrial --help"));
}

TEST_CASE("a misspelt option is answered with the one that was probably meant") {
  const TempFolder folder;
  const auto errors_of = [&](const std::vector<std::string>& arguments) {
    const ProgramResult result = run_touchtrial(folder.path(), arguments);
    CHECK(result.exit_code == 2);
    CHECK(line_count(result.errors) == 1);
    return result.errors;
  };
  CHECK_THAT(errors_of({"exclude", "a.db", "--participant", "P07", "--reasn", "asleep"}),
             holds_text("--reasn: is not an option; did you mean --reason?"));
  CHECK_THAT(errors_of({"stimuli", "sheet", "a.json", "--outptu=b.png"}),
             holds_text("--outptu: is not an option; did you mean --output?"));
  CHECK_THAT(errors_of({"close", "a.db", "--quite-another"}),
             !holds_text("did you mean") && holds_text("--quite-another"));
}
