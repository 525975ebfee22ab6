from layered import blob, openraster

from app.document.settings import Meshing
from app.solving.resolve_keys import KeyResolver, step_resolver
from app.storage.scenes.drawings import open_layered


def test_a_layer_that_is_built_anew_stays_where_it_is(tmp_path):
    path = tmp_path / "head.ora"
    stack = '<layer name="head" src="data/0.png" x="60" y="10"/>'
    path.write_bytes(openraster((200, 220), stack, [blob(70, 50)]))
    opened = open_layered(path, Meshing(triangles=4_000))
    (head,) = opened.document.layers
    resolver = KeyResolver(before=head, bounds=head.bounds, meshing=Meshing(triangles=5_000))
    while not resolver.is_over:
        resolver = step_resolver(resolver, opened.pictures[head.id].rgba)
    assert abs(resolver.new_layer.domain.outline.mean() - head.domain.outline.mean()) < 1
    (again,) = resolver.command(opened.document).layers
    assert again.corner == head.corner == 60 + 160j
