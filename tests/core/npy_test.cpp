#include "core/npy.hpp"

#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/npy_array.hpp"
#include "support/temp_folder.hpp"

#include <string>

using namespace touchtrial;

TEST_CASE("an npy file follows NumPy's format to the byte") {
  const TempFolder folder;
  const auto path = folder.path() / "a.npy";
  GreyImage image(1, 2);
  image.at(0, 0) = 7;
  image.at(0, 1) = 200;
  write_npy(path, image);
  std::string header = "{'descr': '|u1', 'fortran_order': False, 'shape': (1,2,), }";
  header.resize(117, ' ');
  header += '\n';
  const std::string begin("\x93NUMPY\x01\x00\x76\x00", 10);
  CHECK(text_of(read_file(path)) == begin + header + "\x07\xC8");
}

TEST_CASE("an npy file gives back what was written, for every sample type") {
  const TempFolder folder;
  const auto path = folder.path() / "a.npy";
  Plane<double> plane(3, 5);
  for (std::size_t i = 0; i < plane.size(); ++i) plane.samples()[i] = static_cast<double>(i) - 2.5;
  write_npy(path, plane);
  const NpyArray array = read_npy(path);
  CHECK(array.type == "<f8");
  CHECK(array.shape == std::vector<int>{3, 5});
  CHECK(array.samples == std::vector<double>(plane.samples().begin(), plane.samples().end()));

  write_npy(path, converted<float>(plane));
  CHECK(read_npy(path).type == "<f4");
  CHECK(read_npy(path).samples[4] == 1.5);

  write_npy(path, GreyImage(1, 2, 200));
  CHECK(read_npy(path).type == "|u1");
  CHECK(read_npy(path).samples == std::vector<double>{200.0, 200.0});
}

TEST_CASE("an npy file's data start on a multiple of 64 bytes, as NumPy's own do") {
  const TempFolder folder;
  const auto path = folder.path() / "a.npy";
  const std::vector<float> samples(24);
  write_npy<float>(path, samples, {2, 6, 2});
  CHECK((read_file(path).size() - samples.size() * sizeof(float)) % 64 == 0);
  CHECK(read_npy(path).shape == std::vector<int>{2, 6, 2});
}
