; The installer for Windows, by Inno Setup 6:
;   iscc /DVersion=1.0.0 /DFolder=C:\out\lissom lissom.iss
; It needs no rights of an administrator, and takes back all that it entered.
#ifndef Version
  #error Say which version it is: /DVersion=…
#endif
#ifndef Folder
  #error Say where the folder is that PyInstaller made: /DFolder=…
#endif

[Setup]
AppId=io.github.lissom
AppName=Lissom
AppVersion={#Version}
AppPublisher=The Lissom project
DefaultDirName={autopf}\Lissom
DefaultGroupName=Lissom
DisableProgramGroupPage=yes
PrivilegesRequired=lowest
PrivilegesRequiredOverridesAllowed=dialog
ArchitecturesAllowed=x64compatible
ArchitecturesInstallIn64BitMode=x64compatible
LicenseFile=..\..\LICENSE
UninstallDisplayIcon={app}\lissom-window.exe
ChangesAssociations=yes
ChangesEnvironment=yes
Compression=lzma2
SolidCompression=yes
WizardStyle=modern

[Tasks]
Name: desktopicon; Description: "{cm:CreateDesktopIcon}"; Flags: unchecked
Name: path; Description: "Let the prompt find the command lissom"; Flags: unchecked

[InstallDelete]
; What an older version had and this one has not.
Type: filesandordirs; Name: "{app}\_internal"

[Files]
Source: "{#Folder}\*"; DestDir: "{app}"; Flags: recursesubdirs createallsubdirs ignoreversion

[Icons]
Name: "{group}\Lissom"; Filename: "{app}\lissom-window.exe"
Name: "{autodesktop}\Lissom"; Filename: "{app}\lissom-window.exe"; Tasks: desktopicon

[Registry]
Root: HKA; Subkey: "Software\Classes\.lissom"; ValueType: string; ValueData: "Lissom.Project"; Flags: uninsdeletevalue
Root: HKA; Subkey: "Software\Classes\.lissom"; ValueType: string; ValueName: "Content Type"; ValueData: "application/x-lissom"; Flags: uninsdeletevalue
Root: HKA; Subkey: "Software\Classes\Lissom.Project"; ValueType: string; ValueData: "Lissom project"; Flags: uninsdeletekey
Root: HKA; Subkey: "Software\Classes\Lissom.Project\DefaultIcon"; ValueType: string; ValueData: "{app}\lissom-window.exe,0"
Root: HKA; Subkey: "Software\Classes\Lissom.Project\shell\open\command"; ValueType: string; ValueData: """{app}\lissom-window.exe"" ""%1"""

[Code]
const
  Environment = 'Environment';

function HasPath(Paths: string): Boolean;
begin
  Result := Pos(';' + Uppercase(ExpandConstant('{app}')) + ';', ';' + Uppercase(Paths) + ';') > 0;
end;

procedure CurStepChanged(Step: TSetupStep);
var
  Paths: string;
begin
  if (Step = ssPostInstall) and WizardIsTaskSelected('path') then
  begin
    if not RegQueryStringValue(HKCU, Environment, 'Path', Paths) then
      Paths := '';
    if not HasPath(Paths) then
    begin
      if (Paths <> '') and (Paths[Length(Paths)] <> ';') then
        Paths := Paths + ';';
      RegWriteExpandStringValue(HKCU, Environment, 'Path', Paths + ExpandConstant('{app}'));
    end;
  end;
end;

procedure CurUninstallStepChanged(Step: TUninstallStep);
var
  Paths, Ours: string;
  Place: Integer;
begin
  if (Step = usUninstall) and RegQueryStringValue(HKCU, Environment, 'Path', Paths) and HasPath(Paths) then
  begin
    Ours := ';' + Uppercase(ExpandConstant('{app}')) + ';';
    Paths := ';' + Paths + ';';
    Place := Pos(Ours, Uppercase(Paths));
    Delete(Paths, Place, Length(Ours) - 1);
    Delete(Paths, 1, 1);
    if (Paths <> '') and (Paths[Length(Paths)] = ';') then
      Delete(Paths, Length(Paths), 1);
    RegWriteExpandStringValue(HKCU, Environment, 'Path', Paths);
  end;
end;
