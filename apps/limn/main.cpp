// limn: draws glTF models with smooth silhouettes.
#include <exception>
#include <iostream>
#include <new>
#include <stdexcept>

#include "apps/limn/commands.h"
#include "apps/limn/options.h"
#include "apps/limn/signals.h"
#include "apps/limn/terminal.h"
#include "apps/limn/values.h"
#include "apps/scene/load.h"
#include "apps/scene/output_file.h"

namespace {

int runCommand(const limn::program::CommandLine& line) {
  using namespace limn::program;
  using Command = CommandLine::Command;
  switch (line.command) {
    case Command::kRender:
      return render(line.render);
    case Command::kRefine:
      return refine(line.refine);
    case Command::kInfo:
      return info(line.info);
    case Command::kCompare:
      return compare(line.compare);
    case Command::kVerify:
      return verify(line.verify);
    case Command::kModels:
      return models();
    case Command::kCoarsen:
      return coarsen(line.coarsen);
    case Command::kPrinted:
      return kDone;
  }
  return kFault;
}

int run(int count, const char* const* arguments) {
  const int status = runCommand(limn::program::readCommandLine(count, arguments));
  // What was printed may still lie in a buffer.
  if (!std::cout.flush())
    throw limn::scene::OutputError("standard output could not be written; is the disk full?");
  return status;
}

}  // namespace

int main(int count, char** arguments) {
  using namespace limn::program;
  endOnSignals();
  try {
    return run(count, arguments);
  } catch (const UsageError& error) {
    printError(error.what());
    return kUsage;
  } catch (const limn::scene::InputError& error) {
    printError(error.what());
    return kBadInput;
  } catch (const limn::scene::OutputError& error) {
    printError(error.what());
    return kNotWritten;
  } catch (const std::bad_alloc&) {
    printError("not enough memory; a smaller --size or fewer --threads need less");
    return kFault;
  } catch (const std::exception& error) {
    printError(std::string("a fault of limn, please report it: ") + error.what());
    return kFault;
  }
}
