"""The order of painting, which is uploaded anew only where it is another array."""

import gc
import weakref
from dataclasses import replace

from documents import disc_document

from app.document import clip_of
from app.document.commands import handle_commands
from app.document.commands.layers import layer_commands
from app.motion import TriangleOrder

COUNT = 20  # layers, each with its mesh


def test_each_mesh_keeps_its_order_and_takes_it_along():
    document = handle_commands.add_handle(0, 60 + 45j)(disc_document())
    handle = document.layers[0].handles[-1].id
    clip = clip_of(layer_commands.set_depth(0, handle, 1.0, 20.0)(document), 0)
    mesh = clip.layer.domain.mesh
    orders = [TriangleOrder(replace(mesh, triangles=mesh.triangles.copy())) for _ in range(COUNT)]
    painted = [order.triangles(clip, 0) for order in orders]
    assert painted[0] is not mesh.triangles
    assert all(
        order.triangles(clip, 0) is each for order, each in zip(orders, painted, strict=True)
    )
    gone = [weakref.ref(each) for each in painted]
    del orders, painted
    gc.collect()
    assert not any(each() is not None for each in gone)
