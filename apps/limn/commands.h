// One function per command. They return the exit status of contract and manual and throw what ends them.
#pragma once

#include "apps/limn/options.h"

namespace limn::program {

enum ExitStatus { kDone = 0, kFault = 1, kUsage = 2, kBadInput = 3, kNotWritten = 4, kDifferent = 5 };

int render(const RenderOptions& options);
int refine(const RefineOptions& options);
int info(const InfoOptions& options);
int compare(const CompareOptions& options);
int verify(const VerifyOptions& options);
int models();
int coarsen(const CoarsenOptions& options);

}  // namespace limn::program
