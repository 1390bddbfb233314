#include "brdf/jet.h"
#include "tests/brdf/evaluator_row.h"
#include "tests/brdf/hair/realtime_cases.h"

// Derivatives of the run-time forms by their inputs: finite at the edges, equal to a central difference elsewhere.
namespace likeness::brdf {
namespace {

template <class E>
struct Derived {
  using Form = std::tuple_element_t<0, typename E::Forms>;
  static constexpr int kIn = int(input_count<Form>()), kOut = int(output_count<E>());
  using Jet = ceres::Jet<double, kIn>;

  static std::array<Jet, kOut> at(const std::vector<double>& in) {
    Jet jets[kIn];
    for (int i = 0; i < kIn; ++i) jets[i] = Jet(in[std::size_t(i)], i);
    std::array<Jet, kOut> out;
    const void* tables = nullptr;
    if constexpr (HasTables<E>) tables = &E::tables();
    evaluate_inputs<E, Form>(tables, jets, out.data());
    return out;
  }
};

template <class E>
class HairRealtimeDerivatives : public ::testing::Test {};
using Rows = ::testing::Types<HairKarisRow, HairClosedRow, HairLutRow, HairLutGaussRow, HairTalkLutRow,
                              HairClosedAzimuthRow, HairLutAzimuthRow, EtaPrimeRow>;
struct RowNames {
  template <class E>
  static std::string GetName(int) {
    return std::string(E::kName);
  }
};
TYPED_TEST_SUITE(HairRealtimeDerivatives, Rows, RowNames);

TYPED_TEST(HairRealtimeDerivatives, EqualACentralDifference) {
  using E = TypeParam;
  using Form = typename Derived<E>::Form;
  Random random(1);
  // Tables are linear between nodes: a difference across one is neither side's slope. Few are hit by this step.
  const double step = 1e-6;
  int compared = 0, off = 0;
  for (int n = 0; n < 300; ++n) {
    std::vector<double> in;
    for (const Parameter& p : Form::kInputs)
      for (int c = 0; c < p.channels; ++c) {
        const double middle = 0.5 * (p.typical.low + p.typical.high);
        in.push_back(middle + 0.4 * (p.typical.high - p.typical.low) * random.uniform(-1, 1));
      }
    const auto jets = Derived<E>::at(in);
    for (std::size_t i = 0; i < in.size(); ++i) {
      auto low = in, high = in;
      low[i] -= step;
      high[i] += step;
      const auto below = evaluate_row<E, double>(low), above = evaluate_row<E, double>(high);
      for (std::size_t k = 0; k < below.size(); ++k) {
        const double want = (above[k] - below[k]) / (2 * step), got = jets[k].v[int(i)];
        ++compared;
        off += !(std::abs(got - want) <= 1e-5 * std::abs(want) + 1e-7 * (1 + std::abs(jets[k].a)));
      }
    }
  }
  EXPECT_LE(off, HasTables<E> ? compared / 200 : 0) << "of " << compared;
}

TYPED_TEST(HairRealtimeDerivatives, AreFiniteAtTheEdges) {
  using E = TypeParam;
  using Form = typename Derived<E>::Form;
  Random random(2);
  for (int n = 0; n < 3000; ++n) {
    std::vector<double> in;
    for (const Parameter& p : Form::kInputs)
      for (int c = 0; c < p.channels; ++c) {
        // Poles of the fibre are left out: f has none there but its own.
        const bool pole = p.role == Role::kAngle && p.range.high < 1.6 && p.name != "shift";
        const double high = pole ? 1.5 : p.range.high, low = pole ? -1.5 : p.range.low;
        const double edges[]{low, high, p.initial, std::clamp(0.0, low, high)};
        in.push_back(random.uniform() < 0.8 ? edges[random.index(4)] : random.uniform(low, high));
      }
    const auto jets = Derived<E>::at(in);
    for (std::size_t k = 0; k < jets.size(); ++k)
      for (std::size_t i = 0; i < in.size(); ++i)
        ASSERT_TRUE(std::isfinite(jets[k].v[int(i)])) << "output " << k << " by input " << i << " in case " << n;
  }
}

}  // namespace
}  // namespace likeness::brdf
