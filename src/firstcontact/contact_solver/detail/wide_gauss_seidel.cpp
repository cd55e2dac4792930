#include <firstcontact/contact_solver/detail/contact_batches.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "firstcontact/contact_solver/detail/wide_gauss_seidel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace firstcontact::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class Number>
using Tag = hn::CappedTag<Number, kLanes<Number>>;
template <class Number>
using Vector = hn::Vec<Tag<Number>>;
template <class Number>
using Mask = hn::Mask<Tag<Number>>;

constexpr int kNewtonSteps = 2;

template <class Number>
struct Velocity {
  Vector<Number> n, t0, t1;
};
template <class Number>
using Impulse = Velocity<Number>;

/// Some lanes of a batch, from one on.
template <class Number>
struct Part {
  const ContactBatch<Number>& batch;
  std::size_t from;

  HWY_INLINE Vector<Number> of(const Lanes<Number>& lanes) const {
    return hn::LoadU(Tag<Number>(), lanes.data() + from);
  }
};

/// The coordinates x of the bodies on one side, for some lanes from one on.
template <class Number>
struct Bodies {
  using Places = hn::RebindToSigned<Tag<Number>>;

  HWY_INLINE Bodies(const PairBatch<Number>& pair, std::size_t side, std::size_t from,
                    const Number* all) {
    const Tag<Number> d;
    at = hn::LoadU(Places(), pair.at[side].data() + from);
    x0 = hn::GatherIndex(d, all, at);
    x1 = hn::GatherIndex(d, all + 1, at);
    x2 = hn::GatherIndex(d, all + 2, at);
    x3 = hn::GatherIndex(d, all + 3, at);
    x4 = hn::GatherIndex(d, all + 4, at);
    x5 = hn::GatherIndex(d, all + 5, at);
  }

  HWY_INLINE void put(Number* all) const {
    const Tag<Number> d;
    hn::ScatterIndex(x0, d, all, at);
    hn::ScatterIndex(x1, d, all + 1, at);
    hn::ScatterIndex(x2, d, all + 2, at);
    hn::ScatterIndex(x3, d, all + 3, at);
    hn::ScatterIndex(x4, d, all + 4, at);
    hn::ScatterIndex(x5, d, all + 5, at);
  }

  hn::Vec<Places> at;
  Vector<Number> x0, x1, x2, x3, x4, x5;
};

/// Adds J x to a sum.
template <class Number>
HWY_INLINE Vector<Number> seen(const Part<Number>& part, const std::array<Lanes<Number>, 6>& J,
                               const Bodies<Number>& b, Vector<Number> sum) {
  sum = hn::MulAdd(part.of(J[0]), b.x0, sum);
  sum = hn::MulAdd(part.of(J[1]), b.x1, sum);
  sum = hn::MulAdd(part.of(J[2]), b.x2, sum);
  sum = hn::MulAdd(part.of(J[3]), b.x3, sum);
  sum = hn::MulAdd(part.of(J[4]), b.x4, sum);
  return hn::MulAdd(part.of(J[5]), b.x5, sum);
}

template <class Number>
HWY_INLINE Vector<Number> changed(const Part<Number>& part,
                                  const typename ContactBatch<Number>::Jacobian& J, std::size_t c,
                                  const Impulse<Number>& by, Vector<Number> x) {
  x = hn::MulAdd(part.of(J[0][c]), by.n, x);
  x = hn::MulAdd(part.of(J[1][c]), by.t0, x);
  return hn::MulAdd(part.of(J[2][c]), by.t1, x);
}

template <class Number>
HWY_INLINE void change(const Part<Number>& part, const typename ContactBatch<Number>::Jacobian& J,
                       const Impulse<Number>& by, Bodies<Number>& b) {
  b.x0 = changed<Number>(part, J, 0, by, b.x0);
  b.x1 = changed<Number>(part, J, 1, by, b.x1);
  b.x2 = changed<Number>(part, J, 2, by, b.x2);
  b.x3 = changed<Number>(part, J, 3, by, b.x3);
  b.x4 = changed<Number>(part, J, 4, by, b.x4);
  b.x5 = changed<Number>(part, J, 5, by, b.x5);
}

/// ContactResponse::impulse() for many contacts.
template <class Number>
class Cones {
 public:
  using V = Vector<Number>;

  HWY_INLINE explicit Cones(const Part<Number>& part)
      : W_nn_(part.of(part.batch.normal)),
        inverse_W_nn_(part.of(part.batch.inverse_normal)),
        k0_(part.of(part.batch.coupling[0])),
        k1_(part.of(part.batch.coupling[1])),
        a0_(part.of(part.batch.tangential[0])),
        a1_(part.of(part.batch.tangential[1])),
        friction_(part.of(part.batch.friction)) {}

  /// Computes u without the effect of its own impulse.
  HWY_INLINE Velocity<Number> without(const Impulse<Number>& r, const Velocity<Number>& u) const {
    const V Wr_n = hn::Mul(W_nn_, hn::Add(r.n, coupled(r.t0, r.t1)));
    return {hn::Sub(u.n, Wr_n), hn::Sub(u.t0, hn::MulAdd(k0_, Wr_n, hn::Mul(a0_, r.t0))),
            hn::Sub(u.t1, hn::MulAdd(k1_, Wr_n, hn::Mul(a1_, r.t1)))};
  }

  HWY_INLINE Impulse<Number> impulse(const Velocity<Number>& u_free, Number* sliding) const {
    const Tag<Number> d;
    const V zero = hn::Zero(d);
    const V pressed = hn::Neg(hn::Mul(u_free.n, inverse_W_nn_));
    const V c0 = hn::NegMulAdd(k0_, u_free.n, u_free.t0);
    const V c1 = hn::NegMulAdd(k1_, u_free.n, u_free.t1);
    Impulse<Number> r = held(pressed, c0, c1, zero);
    const V side = hn::Sqrt(hn::MulAdd(r.t0, r.t0, hn::Mul(r.t1, r.t1)));
    const Mask<Number> presses = hn::Lt(u_free.n, zero);
    const Mask<Number> smooth = hn::Eq(friction_, zero);
    const Mask<Number> slides =
        hn::AndNot(smooth, hn::And(presses, hn::Gt(side, hn::Mul(friction_, r.n))));
    if (!hn::AllFalse(d, slides)) {
      slide(pressed, c0, c1, slides, sliding, r);
    }
    r.n = hn::IfThenElseZero(presses, hn::IfThenElse(smooth, pressed, r.n));
    const Mask<Number> rubs = hn::AndNot(smooth, presses);
    r.t0 = hn::IfThenElseZero(rubs, r.t0);
    r.t1 = hn::IfThenElseZero(rubs, r.t1);
    return r;
  }

 private:
  HWY_INLINE V coupled(const V& t0, const V& t1) const {
    return hn::MulAdd(k0_, t0, hn::Mul(k1_, t1));
  }

  /// Computes r_t = -(A + alpha I)^-1 c, and its normal impulse.
  HWY_INLINE Impulse<Number> held(const V& pressed, const V& c0, const V& c1,
                                  const V& alpha) const {
    const Tag<Number> d;
    const V d0 = hn::Add(a0_, alpha);
    const V d1 = hn::Add(a1_, alpha);
    const V inverse = hn::Div(hn::Set(d, Number(-1)), hn::Mul(d0, d1));
    const V t0 = hn::Mul(c0, hn::Mul(d1, inverse));
    const V t1 = hn::Mul(c1, hn::Mul(d0, inverse));
    return {hn::Sub(pressed, coupled(t0, t1)), t0, t1};
  }

  /// Finds the root of mu r_n / |r_t| - 1 for lanes that slide, by two of Newton's steps from the
  /// root of the sweep before. Over the sweeps the roots converge. The tangential part is scaled to
  /// the side of the cone, which makes up for the remaining error.
  HWY_INLINE void slide(const V& pressed, const V& c0, const V& c1, const Mask<Number>& slides,
                        Number* sliding, Impulse<Number>& r) const {
    const Tag<Number> d;
    const V zero = hn::Zero(d);
    const V before = hn::LoadU(d, sliding);
    V alpha = before;
    const Mask<Number> begins = hn::And(slides, hn::Le(alpha, zero));
    if (!hn::AllFalse(d, begins)) {
      alpha = hn::IfThenElse(begins, isotropic(pressed, c0, c1), alpha);
    }
    for (int k = 0; k < kNewtonSteps; ++k) {
      const V d0 = hn::Add(a0_, alpha);
      const V d1 = hn::Add(a1_, alpha);
      const V inverse = hn::Div(hn::Set(d, Number(1)), hn::Mul(d0, d1));
      const V i0 = hn::Mul(d1, inverse);
      const V i1 = hn::Mul(d0, inverse);
      const V t0 = hn::Mul(c0, i0);
      const V t1 = hn::Mul(c1, i1);
      const V allowed = hn::Mul(friction_, hn::Add(pressed, coupled(t0, t1)));
      const V squared = hn::MulAdd(t0, t0, hn::Mul(t1, t1));
      // Rates by alpha are -q.
      const V q0 = hn::Mul(t0, i0);
      const V q1 = hn::Mul(t1, i1);
      const V slope = hn::NegMulAdd(hn::Mul(friction_, coupled(q0, q1)), squared,
                                    hn::Mul(allowed, hn::MulAdd(t0, q0, hn::Mul(t1, q1))));
      const V excess = hn::Sub(allowed, hn::Sqrt(squared));
      alpha = hn::Max(zero, hn::Sub(alpha, hn::Div(hn::Mul(excess, squared), slope)));
    }
    const Impulse<Number> found = held(pressed, c0, c1, alpha);
    const V side = hn::Sqrt(hn::MulAdd(found.t0, found.t0, hn::Mul(found.t1, found.t1)));
    const V allowed = hn::Mul(friction_, found.n);
    const V scale = hn::Div(allowed, side);
    const Mask<Number> is_found =
        hn::And(slides, hn::And(hn::Gt(allowed, zero), hn::Gt(side, zero)));
    hn::StoreU(hn::IfThenElse(slides, hn::IfThenElseZero(is_found, alpha), before), d, sliding);
    const auto put = [&](const V& value, V& to) HWY_ATTR {
      to = hn::IfThenElse(slides, hn::IfThenElseZero(is_found, value), to);
    };
    put(found.n, r.n);
    put(hn::Mul(scale, found.t0), r.t0);
    put(hn::Mul(scale, found.t1), r.t1);
  }

  /// Computes alpha, exact where A is isotropic and nothing is coupled.
  HWY_INLINE V isotropic(const V& pressed, const V& c0, const V& c1) const {
    const V c = hn::Sqrt(hn::MulAdd(c0, c0, hn::Mul(c1, c1)));
    return hn::Max(hn::Zero(Tag<Number>()),
                   hn::Sub(hn::Div(c, hn::Mul(friction_, pressed)), hn::Max(a0_, a1_)));
  }

  V W_nn_, inverse_W_nn_, k0_, k1_, a0_, a1_, friction_;
};

template <class Number>
HWY_INLINE void keep_greatest_change(const Part<Number>& part, const Impulse<Number>& change,
                                     Vector<Number>& greatest) {
  const Vector<Number> squared = hn::MulAdd(
      change.n, change.n, hn::MulAdd(change.t0, change.t0, hn::Mul(change.t1, change.t1)));
  greatest = hn::Max(greatest, hn::Mul(part.of(part.batch.greatest), hn::Sqrt(squared)));
}

/// Solves a contact of each pair. Returns whether that changed anything.
template <class Number>
HWY_INLINE bool solve_contact(const Part<Number>& part, Number* impulses, Number* sliding,
                              Bodies<Number>& A, Bodies<Number>& B, Vector<Number>& greatest) {
  const Tag<Number> d;
  const Vector<Number> zero = hn::Zero(d);
  const auto& [J_A, J_B] = part.batch.J;
  const Velocity<Number> u{
      seen<Number>(part, J_B[0], B, seen<Number>(part, J_A[0], A, part.of(part.batch.free[0]))),
      seen<Number>(part, J_B[1], B, seen<Number>(part, J_A[1], A, part.of(part.batch.free[1]))),
      seen<Number>(part, J_B[2], B, seen<Number>(part, J_A[2], A, part.of(part.batch.free[2])))};
  Number* const r_n = impulses + part.from;
  Number* const r_t0 = r_n + kLanes<Number>;
  Number* const r_t1 = r_t0 + kLanes<Number>;
  const Impulse<Number> r{hn::LoadU(d, r_n), hn::LoadU(d, r_t0), hn::LoadU(d, r_t1)};
  const Mask<Number> acts = hn::Or(
      hn::Lt(u.n, zero), hn::Or(hn::Ne(r.n, zero), hn::Or(hn::Ne(r.t0, zero), hn::Ne(r.t1, zero))));
  if (hn::AllFalse(d, acts)) {
    return false;
  }
  const Cones<Number> cones(part);
  const Impulse<Number> solved = cones.impulse(cones.without(r, u), sliding + part.from);
  const Impulse<Number> by{hn::Sub(solved.n, r.n), hn::Sub(solved.t0, r.t0),
                           hn::Sub(solved.t1, r.t1)};
  hn::StoreU(solved.n, d, r_n);
  hn::StoreU(solved.t0, d, r_t0);
  hn::StoreU(solved.t1, d, r_t1);
  change<Number>(part, J_A, by, A);
  change<Number>(part, J_B, by, B);
  keep_greatest_change<Number>(part, by, greatest);
  return true;
}

/// The data of a sweep.
template <class Number>
struct Sweep {
  const ContactBatch<Number>* batches;
  bool backwards;
  Number* impulses;
  Number* sliding;
  Number* x;
};

template <class Number>
HWY_INLINE void solve_pairs(const Sweep<Number>& sweep, const PairBatch<Number>& pair,
                            std::size_t from, Vector<Number>& greatest) {
  Bodies<Number> A(pair, 0, from, sweep.x);
  Bodies<Number> B(pair, 1, from, sweep.x);
  bool changed = false;
  for (std::size_t i = 0; i < pair.count; ++i) {
    const std::size_t k = pair.first + (sweep.backwards ? pair.count - 1 - i : i);
    changed |=
        solve_contact<Number>({sweep.batches[k], from}, sweep.impulses + 3 * kLanes<Number> * k,
                              sweep.sliding + kLanes<Number> * k, A, B, greatest);
  }
  if (changed) {
    A.put(sweep.x);
    B.put(sweep.x);
  }
}

template <class Number>
HWY_INLINE Number sweep_pairs(const Sweep<Number>& sweep, const PairBatch<Number>* pairs,
                              std::size_t count) {
  const Tag<Number> d;
  Vector<Number> greatest = hn::Zero(d);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = sweep.backwards ? count - 1 - i : i;
    for (std::size_t from = 0; from < kLanes<Number>; from += hn::Lanes(d)) {
      solve_pairs<Number>(sweep, pairs[k], from, greatest);
    }
  }
  return hn::GetLane(hn::MaxOfLanes(d, greatest));
}

double SweepDoubles(const PairBatch<double>* pairs, std::size_t count,
                    const ContactBatch<double>* batches, bool backwards, double* impulses,
                    double* sliding, double* x) {
  return sweep_pairs<double>({batches, backwards, impulses, sliding, x}, pairs, count);
}

float SweepFloats(const PairBatch<float>* pairs, std::size_t count,
                  const ContactBatch<float>* batches, bool backwards, float* impulses,
                  float* sliding, float* x) {
  return sweep_pairs<float>({batches, backwards, impulses, sliding, x}, pairs, count);
}

}  // namespace firstcontact::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace firstcontact::detail {
namespace {

HWY_EXPORT(SweepDoubles);
HWY_EXPORT(SweepFloats);

}  // namespace

double wide_gauss_seidel(const std::vector<PairBatch<double>>& pairs,
                         const std::vector<ContactBatch<double>>& batches, bool backwards,
                         double* impulses, double* sliding, double* x) {
  return HWY_DYNAMIC_DISPATCH(SweepDoubles)(pairs.data(), pairs.size(), batches.data(), backwards,
                                            impulses, sliding, x);
}

float wide_gauss_seidel(const std::vector<PairBatch<float>>& pairs,
                        const std::vector<ContactBatch<float>>& batches, bool backwards,
                        float* impulses, float* sliding, float* x) {
  return HWY_DYNAMIC_DISPATCH(SweepFloats)(pairs.data(), pairs.size(), batches.data(), backwards,
                                           impulses, sliding, x);
}

}  // namespace firstcontact::detail
#endif
