"""The words of questions and answers, as in scenes and results."""

import enum


class Verdict(enum.StrEnum):
    """What is proven of a step; each member equals its word, as ``"free"``."""

    free = "free"
    """Farther apart than the margin at all times."""
    contact = "contact"
    """So before t; at t no farther than margin + tolerance."""
    contact_at_start = "contact_at_start"
    """As ``contact``, with t = 0."""
    undecided = "undecided"
    """So before t, nothing known after it; see ``reason``."""


class UndecidedReason(enum.StrEnum):
    """Why a search ended without a verdict."""

    none = "none"
    work = "work"
    deadline = "deadline"
    memory = "memory"
    precision = "precision"
    cancelled = "cancelled"


class StartContacts(enum.StrEnum):
    """What becomes of pairs that start within margin + tolerance."""

    report = "report"
    """``contact_at_start``."""
    keep_half = "keep_half"
    """A feature pair that starts there, but apart, is held to half its start distance."""


class ContactState(enum.StrEnum):
    """Which contacts a result lists; or a number: so many at most of each two bodies, the nearest
    and some of every region (1000 where nothing is said).
    """

    none = "none"
    """Only the time."""
    first = "first"
    """The feature pair that decided."""
    all = "all"
    """Every feature pair within the band at t."""


class FeatureType(enum.StrEnum):
    """What a feature is."""

    vertex = "vertex"
    edge = "edge"
    face = "face"


class Between(enum.StrEnum):
    """How a motion runs between two poses."""

    constant_velocity = "constant_velocity"
    """The body origin moves on a line, the body turns at a constant rate."""
    screw = "screw"
    """One rotation about, and one translation along, one axis."""


class Filling(enum.StrEnum):
    """Whether the space that a closed mesh encloses belongs to the shape."""

    surface = "surface"
    solid = "solid"


class ElementaryVerdict(enum.StrEnum):
    """How an elementary test ends."""

    free = "free"
    """Proven: the features do not meet in the window."""
    contact = "contact"
    """They meet between ``t_lower`` and ``t_upper``."""
    degenerate = "degenerate"
    """Proven free before ``t_lower``, where they touch up to rounding."""


class JointLimit(enum.StrEnum):
    """Which limit of a joint."""

    lower_position = "lower_position"
    upper_position = "upper_position"
    velocity = "velocity"


class JointType(enum.StrEnum):
    """How a link may move against its parent."""

    fixed = "fixed"
    revolute = "revolute"
    continuous = "continuous"
    prismatic = "prismatic"
    screw = "screw"
    planar = "planar"
    floating = "floating"
    ball = "ball"


class Turning(enum.StrEnum):
    """Which way a continuous joint goes from one position to the next."""

    long = "long"
    """As the numbers say, whole turns included."""
    short = "short"
    """By at most half a turn."""


class ProofVerdict(enum.StrEnum):
    """What a second proof says of a run, a result or a path."""

    proven = "proven"
    """All that it claims, as far as a second proof covers it."""
    refuted = "refuted"
    """Proven: one of its claims is wrong, such as two bodies that come too close."""
    broken = "broken"
    """It contradicts itself or its scene, such as by a body that jumps."""
    not_proven = "not_proven"
    """Neither; the pair and the times that are left open are named."""
