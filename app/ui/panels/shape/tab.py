"""The tab of the layer's shape: its limits, its stiff parts and bones and, folded, its mesh."""

from imgui_bundle import imgui

from app.editor import Action, Project, Session
from app.texts import _
from app.ui.panels.shape.limits import draw_limits
from app.ui.panels.shape.material import draw_material
from app.ui.panels.shape.mesh import draw_mesh
from app.ui.style.theme import Look

_FOLD = imgui.TreeNodeFlags_.no_tree_push_on_open | imgui.TreeNodeFlags_.frame_padding


def draw_shape_panel(session: Session, look: Look, project: Project) -> list[Action]:
    if project.layer_runtime.shown is None:
        return []
    actions = draw_limits(look, project) + draw_material(session, look, project)
    if imgui.tree_node_ex(f"{_('More')}###more of shape", _FOLD):
        actions += draw_mesh(session, look, project)
    return actions
