#include "app/program.hpp"

int main(int argc, char** argv) {
  return touchtrial::app::run_program(argc, argv);
}
