"""stand_in_bpy.py SCRIPT OWNER: runs Glint's Blender script against a stand-in for bpy.

Only `material` or `cycles`, as OWNER says, has displacement_method, as in Blender 4.1 and later and
before. Prints what the script set it to.
"""
import sys
import types


class Anything:
    def __getattr__(self, name):
        value = Anything()
        object.__setattr__(self, name, value)
        return value

    def __getitem__(self, key):
        return self.__dict__.setdefault("_items", {}).setdefault(key, Anything())

    def __iter__(self):
        return iter([Anything() for _ in range(4)])

    def __call__(self, *args, **kwargs):
        return Anything()


class NoMethod:
    __slots__ = ()


class WithMethod:
    __slots__ = ("displacement_method",)


class Cycles:
    def __init__(self, settings):
        self.cycles = settings
        self.node_tree = Anything()


class CyclesOnly(Cycles):
    __slots__ = ()

    def __setattr__(self, name, value):
        if name == "displacement_method":
            raise AttributeError(name)
        object.__setattr__(self, name, value)


class Material(Cycles):
    displacement_method = "BUMP"


script, owner = sys.argv[1:]
made = Material(NoMethod()) if owner == "material" else CyclesOnly(WithMethod())
bpy = types.ModuleType("bpy")
bpy.context = Anything()
bpy.context.space_data = None
bpy.data = Anything()
bpy.types = Anything()
bpy.data.materials.new = lambda name: made
sys.modules["bpy"] = bpy
text = open(script).read().replace("USE_DISPLACEMENT = False", "USE_DISPLACEMENT = True")
exec(compile(text, script, "exec"), {"__name__": "__main__", "__file__": script})
print(made.displacement_method if owner == "material" else made.cycles.displacement_method)
