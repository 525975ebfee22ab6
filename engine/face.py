"""All names of `import engine`; the rooms have more."""

from engine.deform import (
    Deformer as Deformer,
    Handles as Handles,
    State as State,
    Status as Status,
)
from engine.domain import (
    Domain as Domain,
    MeshedDomain as MeshedDomain,
    build_domain as build_domain,
    domain_of_polygon as domain_of_polygon,
)
from engine.errors import EngineError as EngineError
from engine.interpolation import (
    Frame as Frame,
    Prepared as Prepared,
    Proof as Proof,
    Variant as Variant,
    prepare as prepare,
    prove as prove,
)
from engine.maps import (
    Boundary as Boundary,
    Bounds as Bounds,
    Certificate as Certificate,
    HarmonicMap as HarmonicMap,
    certify as certify,
    distortion as distortion,
)
from engine.reference import Reference as Reference
from engine.streaming import (
    Positions as Positions,
    Series as Series,
    build_series as build_series,
    finish as finish,
)
