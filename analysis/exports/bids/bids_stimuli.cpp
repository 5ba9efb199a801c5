#include "analysis/exports/bids/bids_stimuli.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis {

std::string stimulus_name(const design::Study& study, int class_index, int exemplar) {
  const design::StudyClass& of = study.classes.at(class_index);
  return fmt::format("{:02}-{}-{:02}{}", class_index + 1, plain_label(of.label), exemplar + 1,
                     of.images.at(exemplar).extension().string());
}

std::vector<ExportFile> stimulus_files(const design::Study& study) {
  std::vector<ExportFile> files;
  for (int i = 0; i < static_cast<int>(study.classes.size()); ++i) {
    for (int k = 0; k < static_cast<int>(study.classes[i].images.size()); ++k) {
      const std::filesystem::path image = study.folder / study.classes[i].images[k];
      if (!is_there(image)) {
        throw FileError(one_line(image.string()) +
                        ": the study's image is not there; put it back, or leave out "
                        "--with-stimuli");
      }
      files.push_back(
          {"stimuli/" + stimulus_name(study, i, k), [image](const std::filesystem::path& path) {
             replace_file(path, ByteView(read_file(image)));
           }});
    }
  }
  return files;
}

}  // namespace touchtrial::analysis
