// Independent multiply-add chains, enough of them to hide the latency of two units, on the widest vectors there are.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/limits/peak.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep

#include "bench/limits/peak.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace limn::bench {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

double multiplyAdd(std::int64_t rounds, float& result) {
  const hn::ScalableTag<float> d;
  const auto factor = hn::Set(d, 0.999f), term = hn::Set(d, 0.001f);
  // Different starts, or the compiler would compute one chain for all.
  const auto start = [&](float value) { return hn::Set(d, value); };
  auto a0 = start(0.0f), a1 = start(0.1f), a2 = start(0.2f), a3 = start(0.3f), a4 = start(0.4f);
  auto a5 = start(0.5f), a6 = start(0.6f), a7 = start(0.7f), a8 = start(0.8f), a9 = start(0.9f);
  for (std::int64_t i = 0; i < rounds; ++i) {
    a0 = hn::MulAdd(a0, factor, term);
    a1 = hn::MulAdd(a1, factor, term);
    a2 = hn::MulAdd(a2, factor, term);
    a3 = hn::MulAdd(a3, factor, term);
    a4 = hn::MulAdd(a4, factor, term);
    a5 = hn::MulAdd(a5, factor, term);
    a6 = hn::MulAdd(a6, factor, term);
    a7 = hn::MulAdd(a7, factor, term);
    a8 = hn::MulAdd(a8, factor, term);
    a9 = hn::MulAdd(a9, factor, term);
  }
  const auto low = hn::Add(hn::Add(hn::Add(a0, a1), hn::Add(a2, a3)), a4);
  const auto high = hn::Add(hn::Add(hn::Add(a5, a6), hn::Add(a7, a8)), a9);
  result = hn::GetLane(hn::SumOfLanes(d, hn::Add(low, high)));
  return 2.0 * 10.0 * static_cast<double>(rounds) * static_cast<double>(hn::Lanes(d));
}

}  // namespace HWY_NAMESPACE
}  // namespace limn::bench
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn::bench {
HWY_EXPORT(multiplyAdd);
double multiplyAdd(std::int64_t rounds, float& result) {
  return HWY_DYNAMIC_DISPATCH(multiplyAdd)(rounds, result);
}
}  // namespace limn::bench
#endif
