#include <firstcontact/dynamics/detail/contact_batches.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "firstcontact/dynamics/detail/sweep_batches.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace firstcontact::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, ContactBatch::kLanes>;
using Places = hn::RebindToSigned<Lanes>;
using Vector = hn::Vec<Lanes>;
using Mask = hn::Mask<Lanes>;

constexpr int kNewtonSteps = 2;

struct Velocity {
  Vector n, t0, t1;
};
using Impulse = Velocity;

/// Some lanes of a batch, from one on.
struct Part {
  const ContactBatch& batch;
  std::size_t from;

  HWY_INLINE Vector of(const ContactBatch::Lanes& lanes) const {
    return hn::LoadU(Lanes(), lanes.data() + from);
  }
  HWY_INLINE Velocity of(const std::array<ContactBatch::Lanes, 3>& lanes) const {
    return {of(lanes[0]), of(lanes[1]), of(lanes[2])};
  }
};

/// x of the bodies on one side, of some lanes from one on.
struct Bodies {
  HWY_INLINE Bodies(const PairBatch& pair, std::size_t side, std::size_t from, const double* all) {
    const Lanes d;
    at = hn::LoadU(Places(), pair.at[side].data() + from);
    x0 = hn::GatherIndex(d, all, at);
    x1 = hn::GatherIndex(d, all + 1, at);
    x2 = hn::GatherIndex(d, all + 2, at);
    x3 = hn::GatherIndex(d, all + 3, at);
    x4 = hn::GatherIndex(d, all + 4, at);
    x5 = hn::GatherIndex(d, all + 5, at);
  }

  HWY_INLINE void put(double* all) const {
    const Lanes d;
    hn::ScatterIndex(x0, d, all, at);
    hn::ScatterIndex(x1, d, all + 1, at);
    hn::ScatterIndex(x2, d, all + 2, at);
    hn::ScatterIndex(x3, d, all + 3, at);
    hn::ScatterIndex(x4, d, all + 4, at);
    hn::ScatterIndex(x5, d, all + 5, at);
  }

  hn::Vec<Places> at;
  Vector x0, x1, x2, x3, x4, x5;
};

/// J x, added to a sum.
HWY_INLINE Vector seen(const Part& part, const std::array<ContactBatch::Lanes, 6>& J,
                       const Bodies& b, Vector sum) {
  sum = hn::MulAdd(part.of(J[0]), b.x0, sum);
  sum = hn::MulAdd(part.of(J[1]), b.x1, sum);
  sum = hn::MulAdd(part.of(J[2]), b.x2, sum);
  sum = hn::MulAdd(part.of(J[3]), b.x3, sum);
  sum = hn::MulAdd(part.of(J[4]), b.x4, sum);
  return hn::MulAdd(part.of(J[5]), b.x5, sum);
}

HWY_INLINE Vector changed(const Part& part, const ContactBatch::Jacobian& J, std::size_t c,
                          const Impulse& by, Vector x) {
  x = hn::MulAdd(part.of(J[0][c]), by.n, x);
  x = hn::MulAdd(part.of(J[1][c]), by.t0, x);
  return hn::MulAdd(part.of(J[2][c]), by.t1, x);
}

HWY_INLINE void change(const Part& part, const ContactBatch::Jacobian& J, const Impulse& by,
                       Bodies& b) {
  b.x0 = changed(part, J, 0, by, b.x0);
  b.x1 = changed(part, J, 1, by, b.x1);
  b.x2 = changed(part, J, 2, by, b.x2);
  b.x3 = changed(part, J, 3, by, b.x3);
  b.x4 = changed(part, J, 4, by, b.x4);
  b.x5 = changed(part, J, 5, by, b.x5);
}

/// ContactResponse::impulse() of many contacts.
class Cones {
 public:
  HWY_INLINE explicit Cones(const Part& part)
      : W_nn_(part.of(part.batch.normal)),
        inverse_W_nn_(part.of(part.batch.inverse_normal)),
        k0_(part.of(part.batch.coupling[0])),
        k1_(part.of(part.batch.coupling[1])),
        a0_(part.of(part.batch.tangential[0])),
        a1_(part.of(part.batch.tangential[1])),
        friction_(part.of(part.batch.friction)) {}

  /// u without what its own impulse does.
  HWY_INLINE Velocity without(const Impulse& r, const Velocity& u) const {
    const Vector Wr_n = hn::Mul(W_nn_, hn::Add(r.n, coupled(r.t0, r.t1)));
    return {hn::Sub(u.n, Wr_n), hn::Sub(u.t0, hn::MulAdd(k0_, Wr_n, hn::Mul(a0_, r.t0))),
            hn::Sub(u.t1, hn::MulAdd(k1_, Wr_n, hn::Mul(a1_, r.t1)))};
  }

  HWY_INLINE Impulse impulse(const Velocity& u_free, double* sliding) const {
    const Lanes d;
    const Vector zero = hn::Zero(d);
    const Vector pressed = hn::Neg(hn::Mul(u_free.n, inverse_W_nn_));
    const Vector c0 = hn::NegMulAdd(k0_, u_free.n, u_free.t0);
    const Vector c1 = hn::NegMulAdd(k1_, u_free.n, u_free.t1);
    Impulse r = held(pressed, c0, c1, zero);
    const Vector side = hn::Sqrt(hn::MulAdd(r.t0, r.t0, hn::Mul(r.t1, r.t1)));
    const Mask presses = hn::Lt(u_free.n, zero);
    const Mask smooth = hn::Eq(friction_, zero);
    const Mask slides = hn::AndNot(smooth, hn::And(presses, hn::Gt(side, hn::Mul(friction_, r.n))));
    if (!hn::AllFalse(d, slides)) {
      slide(pressed, c0, c1, slides, sliding, r);
    }
    r.n = hn::IfThenElseZero(presses, hn::IfThenElse(smooth, pressed, r.n));
    const Mask rubs = hn::AndNot(smooth, presses);
    r.t0 = hn::IfThenElseZero(rubs, r.t0);
    r.t1 = hn::IfThenElseZero(rubs, r.t1);
    return r;
  }

 private:
  HWY_INLINE Vector coupled(const Vector& t0, const Vector& t1) const {
    return hn::MulAdd(k0_, t0, hn::Mul(k1_, t1));
  }

  /// r_t = -(A + alpha I)^-1 c, and the normal impulse beside it.
  HWY_INLINE Impulse held(const Vector& pressed, const Vector& c0, const Vector& c1,
                          const Vector& alpha) const {
    const Lanes d;
    const Vector d0 = hn::Add(a0_, alpha);
    const Vector d1 = hn::Add(a1_, alpha);
    const Vector inverse = hn::Div(hn::Set(d, -1.0), hn::Mul(d0, d1));
    const Vector t0 = hn::Mul(c0, hn::Mul(d1, inverse));
    const Vector t1 = hn::Mul(c1, hn::Mul(d0, inverse));
    return {hn::Sub(pressed, coupled(t0, t1)), t0, t1};
  }

  /// The root of mu r_n / |r_t| - 1 by a few of Newton's steps from that of the sweep before: along
  /// with the sweeps they get there. What is missing, the length of the tangential part makes up
  /// for. In lanes that slide.
  HWY_INLINE void slide(const Vector& pressed, const Vector& c0, const Vector& c1,
                        const Mask& slides, double* sliding, Impulse& r) const {
    const Lanes d;
    const Vector zero = hn::Zero(d);
    const Vector before = hn::LoadU(d, sliding);
    Vector alpha = before;
    const Mask begins = hn::And(slides, hn::Le(alpha, zero));
    if (!hn::AllFalse(d, begins)) {
      alpha = hn::IfThenElse(begins, isotropic(pressed, c0, c1), alpha);
    }
    for (int k = 0; k < kNewtonSteps; ++k) {
      const Vector d0 = hn::Add(a0_, alpha);
      const Vector d1 = hn::Add(a1_, alpha);
      const Vector inverse = hn::Div(hn::Set(d, 1.0), hn::Mul(d0, d1));
      const Vector i0 = hn::Mul(d1, inverse);
      const Vector i1 = hn::Mul(d0, inverse);
      const Vector t0 = hn::Mul(c0, i0);
      const Vector t1 = hn::Mul(c1, i1);
      const Vector allowed = hn::Mul(friction_, hn::Add(pressed, coupled(t0, t1)));
      const Vector squared = hn::MulAdd(t0, t0, hn::Mul(t1, t1));
      // Rates by alpha are -q.
      const Vector q0 = hn::Mul(t0, i0);
      const Vector q1 = hn::Mul(t1, i1);
      const Vector slope = hn::NegMulAdd(hn::Mul(friction_, coupled(q0, q1)), squared,
                                         hn::Mul(allowed, hn::MulAdd(t0, q0, hn::Mul(t1, q1))));
      const Vector excess = hn::Sub(allowed, hn::Sqrt(squared));
      alpha = hn::Max(zero, hn::Sub(alpha, hn::Div(hn::Mul(excess, squared), slope)));
    }
    const Impulse found = held(pressed, c0, c1, alpha);
    const Vector side = hn::Sqrt(hn::MulAdd(found.t0, found.t0, hn::Mul(found.t1, found.t1)));
    const Vector allowed = hn::Mul(friction_, found.n);
    const Vector scale = hn::Div(allowed, side);
    const Mask is_found = hn::And(slides, hn::And(hn::Gt(allowed, zero), hn::Gt(side, zero)));
    hn::StoreU(hn::IfThenElse(slides, hn::IfThenElseZero(is_found, alpha), before), d, sliding);
    const auto put = [&](const Vector& value, Vector& to) HWY_ATTR {
      to = hn::IfThenElse(slides, hn::IfThenElseZero(is_found, value), to);
    };
    put(found.n, r.n);
    put(hn::Mul(scale, found.t0), r.t0);
    put(hn::Mul(scale, found.t1), r.t1);
  }

  /// Alpha, exact where A is isotropic and nothing is coupled.
  HWY_INLINE Vector isotropic(const Vector& pressed, const Vector& c0, const Vector& c1) const {
    const Vector c = hn::Sqrt(hn::MulAdd(c0, c0, hn::Mul(c1, c1)));
    return hn::Max(hn::Zero(Lanes()),
                   hn::Sub(hn::Div(c, hn::Mul(friction_, pressed)), hn::Max(a0_, a1_)));
  }

  Vector W_nn_, inverse_W_nn_, k0_, k1_, a0_, a1_, friction_;
};

HWY_INLINE void keep_greatest_change(const Part& part, const Impulse& change, Vector& greatest) {
  const Vector squared = hn::MulAdd(
      change.n, change.n, hn::MulAdd(change.t0, change.t0, hn::Mul(change.t1, change.t1)));
  greatest = hn::Max(greatest, hn::Mul(part.of(part.batch.greatest), hn::Sqrt(squared)));
}

/// Solves a contact of each pair. Whether that changed anything.
HWY_INLINE bool solve_contact(const Part& part, double* impulses, double* sliding, Bodies& A,
                              Bodies& B, Vector& greatest) {
  const Lanes d;
  const Vector zero = hn::Zero(d);
  const auto& [J_A, J_B] = part.batch.J;
  const Velocity u{seen(part, J_B[0], B, seen(part, J_A[0], A, part.of(part.batch.free[0]))),
                   seen(part, J_B[1], B, seen(part, J_A[1], A, part.of(part.batch.free[1]))),
                   seen(part, J_B[2], B, seen(part, J_A[2], A, part.of(part.batch.free[2])))};
  double* const r_n = impulses + part.from;
  double* const r_t0 = r_n + ContactBatch::kLanes;
  double* const r_t1 = r_t0 + ContactBatch::kLanes;
  const Impulse r{hn::LoadU(d, r_n), hn::LoadU(d, r_t0), hn::LoadU(d, r_t1)};
  const Mask acts = hn::Or(
      hn::Lt(u.n, zero), hn::Or(hn::Ne(r.n, zero), hn::Or(hn::Ne(r.t0, zero), hn::Ne(r.t1, zero))));
  if (hn::AllFalse(d, acts)) {
    return false;
  }
  const Cones cones(part);
  const Impulse solved = cones.impulse(cones.without(r, u), sliding + part.from);
  const Impulse by{hn::Sub(solved.n, r.n), hn::Sub(solved.t0, r.t0), hn::Sub(solved.t1, r.t1)};
  hn::StoreU(solved.n, d, r_n);
  hn::StoreU(solved.t0, d, r_t0);
  hn::StoreU(solved.t1, d, r_t1);
  change(part, J_A, by, A);
  change(part, J_B, by, B);
  keep_greatest_change(part, by, greatest);
  return true;
}

/// A sweep and its data.
struct Sweep {
  const ContactBatch* batches;
  bool backwards;
  double* impulses;
  double* sliding;
  double* x;
};

HWY_INLINE void solve_pairs(const Sweep& sweep, const PairBatch& pair, std::size_t from,
                            Vector& greatest) {
  Bodies A(pair, 0, from, sweep.x);
  Bodies B(pair, 1, from, sweep.x);
  bool changed = false;
  for (std::size_t i = 0; i < pair.count; ++i) {
    const std::size_t k = pair.first + (sweep.backwards ? pair.count - 1 - i : i);
    changed |=
        solve_contact({sweep.batches[k], from}, sweep.impulses + 3 * ContactBatch::kLanes * k,
                      sweep.sliding + ContactBatch::kLanes * k, A, B, greatest);
  }
  if (changed) {
    A.put(sweep.x);
    B.put(sweep.x);
  }
}

double SweepBatches(const PairBatch* pairs, std::size_t count, const ContactBatch* batches,
                    bool backwards, double* impulses, double* sliding, double* x) {
  const Lanes d;
  const Sweep sweep{batches, backwards, impulses, sliding, x};
  Vector greatest = hn::Zero(d);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = backwards ? count - 1 - i : i;
    for (std::size_t from = 0; from < ContactBatch::kLanes; from += hn::Lanes(d)) {
      solve_pairs(sweep, pairs[k], from, greatest);
    }
  }
  return hn::GetLane(hn::MaxOfLanes(d, greatest));
}

}  // namespace firstcontact::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace firstcontact::detail {
namespace {

HWY_EXPORT(SweepBatches);

}  // namespace

double sweep_batches(const std::vector<PairBatch>& pairs, const std::vector<ContactBatch>& batches,
                     bool backwards, double* impulses, double* sliding, double* x) {
  return HWY_DYNAMIC_DISPATCH(SweepBatches)(pairs.data(), pairs.size(), batches.data(), backwards,
                                            impulses, sliding, x);
}

}  // namespace firstcontact::detail
#endif
