"""What counts as a change between two sides."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Rules:
    """Limits of the comparison, with the reason of each default.

    They were measured on real recordings of offices and corridors with a scanner at 1 degree and poses good
    to some centimetres: stricter limits lose real objects sooner than they lose false ones.
    """

    min_samples: int = 3  # fewer remembered ranges are one look, perhaps at somebody passing
    min_support: float = 0.5  # share of what is known; 0.75 already loses most objects that were really moved
    min_step_m: float = 0.2  # poses off by 0.15 m must not show; 0.1 m gave half as many false reports again
    min_step_share: float = 0.03  # of the nearer range: a heading error of 1-2 degrees at a slanted wall
    clear_margin: float = 2.0  # in steps: a surface so close to the radius may be clear at the next look
    edge_deg: float = 2.0  # a range shown this close in bearing was only seen round an edge
    min_apart_m: float = (
        0.15  # from all surfaces of the other side: at a flat angle poses shift ranges by more
    )
    max_gap_bins: int = 1  # a coarse scanner leaves single bins empty
    max_jump_m: float = 0.5  # a farther step along one sector is another thing behind
    min_bins: int = 3  # one or two bins are mixed pixels and thin edges
    min_arc_m: float = 0.15  # width of a leg or post; 0.3 m loses boxes and bins
    link_m: float = 0.3  # parts of one thing seen from several nodes, poses included
    min_thing_bins: int = (
        5  # over all nodes: what stands near a path is seen by several, or by one in many bins
    )
    lately_ns: int = 600_000_000_000  # looks older by more than the newest one that could tell do not count
    min_contested: float = (
        0.25  # share of the looks from which a point may have changed: nodes turn one by one
    )
    agreement_before: float = 0.5  # share of all looks at a thing that must say so, on the older side ...
    agreement_after: float = 0.5  # ... and on the newer one: nodes of a slow level turn one after the other
    lone_confirmed_deg: float = (
        120.0  # of its circle; a node that alone shows a thing must be right about the rest
    )
    max_age_ns: int = 3_600_000_000_000  # an angle bin not seen for an hour has no word on what is watched
    move_max_m: float = 1.0  # beyond a metre another thing of which one face shows the same is as likely
    move_two_sides_m: float = 0.2  # shorter side of what was seen from two sides
    move_turned_m: float = 0.5  # by which bounds may differ in size: what is turned farther is told as two
    move_shape_m: float = (
        0.12  # sides that differ by more than bin spacing and noise explain are of two shapes ...
    )
    move_shape_share: float = 0.1  # ... and of long ones, by more than this share

    @classmethod
    def of_level(cls, *, is_fastest: bool) -> "Rules":
        """The rules for a level; the fastest one turns within a pass: if its nodes disagree, somebody walked by."""
        return cls(agreement_before=0.75, agreement_after=0.75) if is_fastest else cls()

    @classmethod
    def of_candidates(cls, *, is_fastest: bool) -> "Rules":
        """The rules for a level beside what the slowest one held before, which has settled.

        A candidate that is not sure in one round is asked for again in the next.
        """
        return cls(agreement_before=0.75, agreement_after=0.75 if is_fastest else 0.67)
