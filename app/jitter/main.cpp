#include "app/jitter/program.hpp"

int main(int argc, char** argv) {
  return touchtrial::app::jitter::run_program(argc, argv);
}
